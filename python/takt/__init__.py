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
from takt.environment import Environment
from takt.errors import (
    ClosedError,
    CommandError,
    ConfigError,
    ConnectionError,
    DriveWarning,
    KeyFileError,
    TaktError,
    TimeoutError,
)
from takt.events import LogError
from takt.feedback import Feedback, FeedbackState
from takt.flex_cam import FlexCam
from takt.forecast import Forecast, Moment
from takt.group import Group
from takt.lcmlog import read_log, write_log
from takt.mover import Mover, MoverRecord
from takt.part import Part
from takt.pick_place import PickPlace
from takt.planar_group import PlanarGroup
from takt.plant import Plant, PlantError
from takt.pose import FreePose
from takt.recording import Recording, RecordingError
from takt.remote import RemoteSession, connect
from takt.replay import ReplayResult, replay
from takt.routing import (
    Journey,
    RoutePlan,
    RoutingError,
    SurfaceJourney,
    SurfaceLeg,
    SurfaceOrder,
    SurfacePlan,
    SurfaceRouter,
    plan_routes,
    plan_surface,
)
from takt.saved import Saved
from takt.session import Recorder, Session
from takt.track import Track, TrackPosition
from takt.trail import TrackTrail

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
    "Environment",
    "Feedback",
    "FeedbackState",
    "FlexCam",
    "Group",
    "Forecast",
    "FreePose",
    "Journey",
    "KeyFileError",
    "Part",
    "PickPlace",
    "PlanarGroup",
    "Plant",
    "PlantError",
    "LogError",
    "Moment",
    "Mover",
    "MoverRecord",
    "Recorder",
    "Recording",
    "RecordingError",
    "RemoteSession",
    "ReplayResult",
    "RoutePlan",
    "RoutingError",
    "Saved",
    "Session",
    "SurfaceJourney",
    "SurfaceLeg",
    "SurfaceOrder",
    "SurfacePlan",
    "SurfaceRouter",
    "TaktError",
    "TimeoutError",
    "Track",
    "TrackPosition",
    "TrackTrail",
    "__version__",
    "connect",
    "error_name",
    "error_text",
    "expect",
    "plan_routes",
    "plan_surface",
    "read_log",
    "read_machine",
    "replay",
    "write_log",
    *_names,
]
