"""Takt: a real-time motion engine.

import takt

with takt.Engine("machine.yaml") as session:  # in process, in virtual time; or takt.connect() to a running taktd
    x = session.axis("x")
    x.power().wait()
    x.move_absolute(position=100.0, velocity=50.0).wait()
"""

from takt import expect
from takt._commands import *  # noqa: F403
from takt._commands import __all__ as _names
from takt._core import __version__
from takt.axis import Axis
from takt.belt import Belt, BeltObject
from takt.engine import Engine, error_name, error_text, read_machine
from takt.errors import ClosedError, CommandError, ConfigError, ConnectionError, DriveWarning, TaktError, TimeoutError
from takt.feedback import Feedback, FeedbackState
from takt.flex_cam import FlexCam
from takt.forecast import Forecast, Moment
from takt.group import Group
from takt.lcmlog import LogError, read_log
from takt.mover import Mover, MoverRecord
from takt.part import Part
from takt.pick_place import PickPlace
from takt.pose import FreePose
from takt.recording import Recording, RecordingError
from takt.remote import RemoteSession, connect
from takt.replay import ReplayResult, replay
from takt.session import Recorder, Session
from takt.track import Track, TrackPosition

__all__ = [
    "Axis",
    "Belt",
    "BeltObject",
    "ClosedError",
    "CommandError",
    "ConfigError",
    "ConnectionError",
    "DriveWarning",
    "Engine",
    "Feedback",
    "FeedbackState",
    "FlexCam",
    "Group",
    "Forecast",
    "FreePose",
    "Part",
    "PickPlace",
    "LogError",
    "Moment",
    "Mover",
    "MoverRecord",
    "Recorder",
    "Recording",
    "RecordingError",
    "RemoteSession",
    "ReplayResult",
    "Session",
    "TaktError",
    "TimeoutError",
    "Track",
    "TrackPosition",
    "__version__",
    "connect",
    "error_name",
    "error_text",
    "expect",
    "read_log",
    "read_machine",
    "replay",
    *_names,
]
