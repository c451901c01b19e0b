"""About how long the rest of a run takes: what its steps were expected to take, corrected by what they take."""

from __future__ import annotations

from collections.abc import Mapping

# What was expected counts beside the measured work as so many times all steps: a step that takes twice its time says
# more about the capture than about the machine
TRUST_RATIO = 1.0
STEP_TRUST_RATIO = 0.3  # likewise, of one step
RANGE_LOW_RATIO, RANGE_HIGH_RATIO = 0.65, 1.8  # of an expectation, between which the time lies
RANGE_UNTIL = 0.25  # of the expected work that is done, from when on one number is said


class TimeLeft:
    """What is left of steps, of which some are done in part.

    Attributes:
        seconds: Expected of each step, by its name, in order.
        step: The present one; None before the first.
    """

    def __init__(
        self, seconds: Mapping[str, float], layered: Mapping[str, float], stages: Mapping[str, Mapping[str, float]]
    ) -> None:
        """Say what is to come.

        Args:
            seconds: Expected of each step, by its name, in order.
            layered: Of those that take others once the step "layers" begins.
            stages: What part of each step its stages take, by their names in order. Without them only its end counts.
        """
        self.seconds, self._layered, self._stages = dict(seconds), dict(layered), stages
        self.step: str | None = None
        self._spent, self._expected = 0.0, 0.0  # seconds of finished steps, and what they were expected to take
        self._began, self._done, self._at = 0.0, 0.0, 0.0  # the step, the part of it that is done, and when it was

    def begin(self, step: str, now: float) -> None:
        """A step begins, and the one before has ended. Those between were taken up or not needed, and count no longer.
        One that was not foreseen takes the place of the next: cameras all around give a surface, where depth from one
        side was foreseen.

        Args:
            now: Seconds of work.
        """
        names = list(self.seconds)
        if self.step in names[:-1] and step not in names:
            names[names.index(self.step) + 1] = step
            self.seconds = dict(zip(names, self.seconds.values(), strict=True))
        if step in names:
            first = names.index(self.step) + 1 if self.step in names else 0
            for needless in names[first : names.index(step)]:
                del self.seconds[needless]
        if self.step in self.seconds:
            self._spent += now - self._began
            self._expected += self.seconds[self.step]
        if step == "layers":
            self.seconds |= self._layered
        self.step, self._began, self._done, self._at = step, now, 0.0, now

    def advance(self, stage: str, done: int, total: int, now: float) -> None:
        """So much of a stage of the step is done.

        Args:
            done: Of `total` parts.
            now: Seconds of work.
        """
        parts = self._stages.get(self.step or "", {})
        if stage not in parts or not total:
            return
        names = list(parts)
        part = sum(parts[name] for name in names[: names.index(stage)]) + parts[stage] * done / total
        if part > self._done:
            self._done, self._at = min(part / sum(parts.values()), 1.0), now

    def left(self, now: float) -> float:
        """Seconds; 0 if nothing was expected.

        Args:
            now: Seconds of work.
        """
        if self.step not in self.seconds:
            return 0.0
        present, measured = self.seconds[self.step], self._at - self._began
        rest = list(self.seconds.values())[list(self.seconds).index(self.step) + 1 :]
        trust = TRUST_RATIO * sum(self.seconds.values())
        done = self._done * present
        pace = (self._spent + measured + trust) / (self._expected + done + trust) if trust else 1.0
        trust = STEP_TRUST_RATIO * present
        own = (measured + trust * pace) / (done + trust) if trust else 1.0
        return max(own * (present - done) - (now - self._at), 0.0) + pace * sum(rest)

    @property
    def number(self) -> tuple[int, int]:
        """Of the present step, from 1, and of all. Layers, of which nothing is expected, count once they begin."""
        at = list(self.seconds).index(self.step or "")
        return at + 1, at + 1 + sum(seconds > 0 for seconds in list(self.seconds.values())[at + 1 :])

    @property
    def is_vague(self) -> bool:
        """Whether too little was done for one number."""
        present = self.seconds.get(self.step or "", 0.0)
        return self._expected + self._done * present < RANGE_UNTIL * sum(self.seconds.values())
