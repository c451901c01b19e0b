"""The program eigenfield, run beside Blender, and what it says meanwhile. Nothing here needs Blender."""

import json
import os
import shutil
import subprocess
import threading

running = set()  # all jobs that have not ended, which end with Blender


class RefusalError(Exception):
    """What the user can correct, in one sentence."""


def find_program(named):
    """The program that the preferences name, else the one that the system finds."""
    found = named or shutil.which("eigenfield")
    if not found:
        raise RefusalError("eigenfield was not found: install it, and name it in the add-on's preferences")
    return found


class Job:
    """One run of the program.

    Attributes:
        progress: The latest line of `--progress json`; empty before the first.
        output: Lines of its standard output.
        said: The latest other line of standard error: after a failure the error.
    """

    def __init__(self, program, *words):
        self.command = [program, *map(str, words)]
        self.progress, self.output, self.said, self.stopped = {}, [], "", False
        try:
            self._process = subprocess.Popen(
                self.command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                encoding="utf-8",
                errors="replace",
                env={**os.environ, "PYTHONIOENCODING": "utf-8"},
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),  # Windows would open a console
            )
        except OSError as error:
            raise RefusalError(f"{program} does not run: {error}") from None
        running.add(self)
        # a pipe that nobody reads stops the program once it is full
        self._readers = [
            threading.Thread(target=self._read, args=(stream, take), daemon=True)
            for stream, take in ((self._process.stdout, self._take_output), (self._process.stderr, self._take_error))
        ]
        for reader in self._readers:
            reader.start()

    def _read(self, stream, take):
        with stream:
            for line in stream:
                if line.strip():
                    take(line.strip())

    def _take_output(self, line):
        self.output.append(line)

    def _take_error(self, line):
        if not line.startswith("{"):
            self.said = line
            return
        try:
            self.progress = json.loads(line)
        except ValueError:  # it was stopped within a line
            self.said = line

    @property
    def is_running(self):
        if self._process.poll() is None or any(reader.is_alive() for reader in self._readers):
            return True
        running.discard(self)
        return False

    @property
    def error(self):
        """Why it has failed, in the program's own line; None if it has not."""
        code = self._process.poll()
        return (self.said or f"{self.command[0]} failed") if code and not self.stopped else None

    @property
    def part(self):
        """How much is done, from 0 to 1; None where that is not known."""
        line = self.progress
        return line["done"] / line["total"] if line.get("part") is None and line.get("total") else line.get("part")

    @property
    def words(self):
        """What it is doing, and how long the rest takes."""
        line = self.progress
        words = line.get("step") or line.get("stage") or "starting", line.get("left"), line.get("note")
        return ", ".join(word for word in words if word)

    def steps(self):
        """Wait for its end; yields how far it is, and returns it. Raises RefusalError where it failed, and stops it
        where nobody waits any more."""
        try:
            while self.is_running:
                yield self.part or 0, self.words
        finally:
            if self.is_running:
                self.stop()
        if self.error:
            raise RefusalError(self.error)
        return self

    def stop(self):
        """Ask it to end. It removes what it has begun to write."""
        self.stopped = True
        self._process.terminate()


def stop_all():
    for job in list(running):
        job.stop()
    running.clear()
