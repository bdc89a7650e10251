"""`takt opcua` and `takt opcua-user`."""

from __future__ import annotations

import contextlib
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from takt import _core
from takt.errors import TaktError

FILE = click.Path(path_type=Path)
LOOK_S = 0.2  # [s] between two checks of the server and the engine's process
OWN_ENGINE_S = 20.0  # [s] in which an engine started here has to answer
FAILED = 1


def _say(sentence: str) -> None:
    click.echo(sentence, err=True)


@click.command()
@click.argument("machine", type=FILE, required=False)
@click.option("--connect", "url", metavar="URL", help="The engine of this LCM network, instead of one for MACHINE.")
@click.option("--host", default="127.0.0.1", show_default=True, help="Address to listen on; 0.0.0.0: on all.")
@click.option("--port", default=4840, show_default=True, type=click.IntRange(0, 65535), help="0: any that is free.")
@click.option("--rate", default=10.0, show_default=True, type=click.FloatRange(1, 100), help="Hz, of values.")
@click.option("--allow-commands", is_flag=True, help="Clients may command, too [they may only read].")
@click.option("--users", type=FILE, help="File with users and their rights (takt opcua-user) [no names are asked for].")
@click.option("--certificate", type=FILE, help="Of the server: encrypted connections only.")
@click.option("--private-key", type=FILE, help="Of this certificate.")
@click.option("--trust", type=FILE, help="Folder with the certificates of those clients that may connect [all].")
@click.option("--pace", default="paced", show_default=True, help="Of an engine for MACHINE: paced, real-time or fast.")
@click.option("--key", type=FILE, help="File with the key of the engine [TAKT_KEY_FILE, else none].")
def opcua(machine: Path | None, url: str | None, pace: str, key: Path | None, **given: Any) -> int:
    """Serve an engine to PLCs and plants over OPC UA: that of a MACHINE file, which is then started in a taktd of its
    own, or the running one of an LCM network."""
    if (machine is None) == (url is None):
        raise click.UsageError("give a MACHINE file, or the network of a running engine with --connect")
    try:
        from takt.opcua.server import Options
    except ImportError as error:
        raise TaktError(f"takt opcua needs {error.name}: pip install 'takt-motion[opcua]'") from None
    given["rate_hz"], given["commands"] = given.pop("rate"), given.pop("allow_commands")
    options = Options(**given, timeout_s=OWN_ENGINE_S if machine is not None else 5.0)
    options.check()
    return _run(machine, url or "", options, pace, key)


def _run(machine: Path | None, url: str, options: Any, pace: str, key_file: Path | None) -> int:
    from takt.demo import free_url, taktd
    from takt.ending import end_in_order
    from takt.engine import read_machine
    from takt.keys import read_key
    from takt.opcua.server import serving

    key = read_key(key_file)
    end_in_order()
    with contextlib.ExitStack() as stack:
        process: subprocess.Popen[bytes] | None = None
        if machine is not None:
            _core.load_machine(*read_machine(machine))  # raises ConfigError if the file is invalid
            url = free_url()
            directory = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="takt-opcua-")))
            process = stack.enter_context(taktd(machine, url, None, pace, directory, key))
        address, why = stack.enter_context(serving(url, options, key, _say))
        rights = "commands and values" if options.commands else "values, read-only"
        _say(f"the engine on {url}: {address} ({rights}; Ctrl-C ends it)")
        return _until_it_ends(process, why)


def _until_it_ends(process: subprocess.Popen[bytes] | None, why: Callable[[], str]) -> int:
    while process is None or process.poll() is None:
        if why():
            _say(f"takt: {why()}")
            return FAILED
        time.sleep(LOOK_S)
    _say("taktd has ended")
    return 0 if process.returncode == 0 else FAILED


@click.command("opcua-user")
@click.argument("file", type=FILE)
@click.argument("name")
@click.option("--commands", is_flag=True, help="May command, too [may only read].")
@click.option("--password", help="[asked for]")
def opcua_user(file: Path, name: str, commands: bool, password: str | None) -> int:
    """Add a user to the FILE that takt opcua --users reads, or replace the password and rights of a user."""
    from takt.opcua.users import COMMANDS, READ, add_user

    if password is None:
        password = str(click.prompt("password", hide_input=True, confirmation_prompt=True, err=True))
    add_user(file, name, password, COMMANDS if commands else READ)
    print(f"{file}: {name} may {'command' if commands else 'read'}")
    return 0
