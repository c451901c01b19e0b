"""The command line: one file a verb, loaded when it is called."""

from __future__ import annotations

import _thread
import contextlib
import difflib
import importlib
import logging
import os
import signal
import sys
import threading
from types import FrameType
from typing import NoReturn

import click
from click.shell_completion import shell_complete

from eigenfield.cli.completion import COMPLETION_VARIABLE
from eigenfield.cli.limits import limit_of
from eigenfield.cli.streams import prepare_streams
from eigenfield.core.arguments import on_command_line
from eigenfield.core.errors import EigenfieldError, one_line
from eigenfield.core.shell import shell_word
from eigenfield.core.version import __version__
from eigenfield.runtime.children import kill_children
from eigenfield.runtime.objects import name_address
from eigenfield.runtime.signals import STOP_SIGNALS, end_no_step
from eigenfield.runtime.temporary import remove_temporaries

VERBS = {
    "demo": "Try the whole way, on photographs that the program draws.",
    "inspect": "Say what a capture holds, what is wrong with it, and what to run next.",
    "encode": "Turn photographs into one .glb.",
    "view": "Look around in a scene, in a browser or a headset.",
    "export": "Write a scene as a page, a video, OBJ, texture maps, a quilt or a COLMAP model.",
    "evaluate": "Measure a scene against its photographs.",
    "render": "Draw one view, or a flight through a scene.",
    "info": "Show what a scene file holds.",
    "validate": "Check a scene file and list every finding.",
    "calibrate": "Find cameras only, from photographs of the scene or of a chart.",
    "proxy": "Make cameras and mesh only.",
    "batch": "Encode and measure many captures, here or on many machines.",
    "help": "Read a page of the documentation.",
    "completion": "Print the script that completes commands in bash, zsh or fish.",
}


class _Verbs(click.Group):
    """Loads a verb's module only when it is asked for, so that `--help` and errors come at once."""

    def list_commands(self, context: click.Context) -> list[str]:
        return list(VERBS)

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        if name not in VERBS:
            return None
        command: click.Command = importlib.import_module(f"eigenfield.cli.{name}").command
        return command

    def resolve_command(
        self, context: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args[0] not in VERBS and not args[0].startswith("-"):
            near = difflib.get_close_matches(args[0], VERBS, n=1)
            remedy = f"did you mean {near[0]}?" if near else "`eigenfield --help` lists them"
            context.fail(f"No such command {args[0]!r}; {remedy}")
        return super().resolve_command(context, args)

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(VERBS.items()))


@click.command(
    cls=_Verbs,
    epilog="""\b
Examples:
  eigenfield demo
  eigenfield inspect photos/
  eigenfield encode photos/ -o scene.glb
  eigenfield view scene.glb
  eigenfield evaluate scene.glb photos/""",
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)
@click.version_option(__version__, prog_name="eigenfield")
def group() -> None:
    """Turn photographs of a scene into one small .glb in which anyone can look around."""


SIGNAL_RETRY_SECONDS = 0.05
STOP_SECONDS = 5.0  # from a signal to the end of the process at the latest
_signals: list[int] = []  # those that have stopped this process


def _stop(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt, but not within an import: trimesh takes any exception there for a missing package and
    goes on without it, and a C module turns it into an ImportError. The signal comes again a little later."""
    while frame is not None:
        if frame.f_code.co_filename == "<frozen importlib._bootstrap>":
            again = threading.Timer(SIGNAL_RETRY_SECONDS, _signal_main_thread, [number])
            again.daemon = True
            again.start()
            return
        frame = frame.f_back
    if _signals:  # a second one, while the first is being obeyed
        _exit_interrupted()
    _signals.append(number)
    kill_children()  # a thread may wait for one
    late = threading.Timer(STOP_SECONDS, _exit_interrupted)  # others compute in a library for long
    late.daemon = True
    with contextlib.suppress(RuntimeError):  # the system has no more threads
        late.start()
    raise KeyboardInterrupt


def _signal_main_thread(number: int) -> None:
    if sys.platform == "win32":
        _thread.interrupt_main(number)
    else:  # wakes it also where it waits for a lock
        signal.pthread_kill(threading.main_thread().ident or 0, number)


def _exit_interrupted() -> NoReturn:
    with contextlib.suppress(ValueError):  # not in the main thread
        for number in STOP_SIGNALS:
            signal.signal(number, signal.SIG_IGN)
    end_no_step()
    kill_children()
    remove_temporaries()
    with contextlib.suppress(OSError, RuntimeError):  # the terminal has gone; the signal came within a write
        click.echo("eigenfield: interrupted", err=True)
        sys.stdout.flush()
    os._exit(130)  # threads in the middle of a kernel or a codec are not waited for


def main() -> None:
    """Entry point: exit code 0, 2 for an error that a person can correct, 130 when interrupted; a bug keeps its
    traceback and exits with 1."""
    prepare_streams()
    completion = os.environ.get(COMPLETION_VARIABLE)
    if completion is not None:  # by the script of `eigenfield completion`
        sys.exit(shell_complete(group, {}, "eigenfield", COMPLETION_VARIABLE, completion))
    logging.basicConfig(format="%(message)s", level=logging.WARNING)
    with contextlib.suppress(ValueError):  # not in the main thread
        for number in STOP_SIGNALS:
            if signal.getsignal(number) is not signal.SIG_IGN:  # SIGINT is in the background, SIGHUP by nohup
                signal.signal(number, _stop)
    context: dict[str, object] = {}
    try:
        with on_command_line(), group.make_context("eigenfield", sys.argv[1:]) as root:
            context = root.meta
            group.invoke(root)
    except click.exceptions.Exit as error:
        sys.exit(error.exit_code)
    except click.ClickException as error:
        error.show()
        named = [word for word in sys.argv[1:] if word.startswith("-") and os.path.lexists(word)]
        if isinstance(error, click.NoSuchOption) and named:
            click.echo(f"To name what is called so, say {shell_word(named[0])}", err=True)
        sys.exit(2)
    except EigenfieldError as error:
        if _signals:  # a library has caught the KeyboardInterrupt and failed later
            _exit_interrupted()
        if context.get("traceback"):
            raise
        click.echo(f"eigenfield: {name_address(error)}", err=True)
        sys.exit(2)
    except (KeyboardInterrupt, click.Abort):
        _exit_interrupted()
    except BrokenPipeError:
        if _signals:
            _exit_interrupted()
        sys.stderr.close()
        sys.exit(141)
    except Exception as error:
        if _signals:
            _exit_interrupted()
        limit = limit_of(error)
        if limit is None or context.get("traceback"):
            raise
        click.echo(f"eigenfield: {one_line(limit[0])}; {limit[1]}", err=True)
        sys.exit(2)
