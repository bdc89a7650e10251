"""Motion checks: each one judges a recording and returns a `Verdict`. A motion that fails a check never raises; only
arguments that make no sense do. `takt.expect` has the same functions in their asserting form."""

from takt.checks.conditions import complete, never_both, stays, visits_states
from takt.checks.limits import continuous, within_limits
from takt.checks.pairs import in_sync, keeps_distance
from takt.checks.paths import follows_path
from takt.checks.targets import reaches, settles

__all__ = [
    "complete",
    "continuous",
    "follows_path",
    "in_sync",
    "keeps_distance",
    "never_both",
    "reaches",
    "settles",
    "stays",
    "visits_states",
    "within_limits",
]
