"""Ways for many movers at once: `plan_routes` finds them, `Session.move_on_tracks` goes them."""

from takt.routing.journey import Journey, move_on_tracks
from takt.routing.plan import RoutePlan, plan_routes
from takt.routing.streets import RoutingError

__all__ = ["Journey", "RoutePlan", "RoutingError", "move_on_tracks", "plan_routes"]
