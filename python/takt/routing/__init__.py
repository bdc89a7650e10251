"""Ways for many movers at once: `plan_routes` finds them, `Session.move_on_tracks` has them gone."""

from takt.routing.journey import Journey
from takt.routing.plan import RoutePlan, plan_routes
from takt.routing.streets import RoutingError

__all__ = ["Journey", "RoutePlan", "RoutingError", "plan_routes"]
