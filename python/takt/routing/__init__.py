"""Ways for many movers at once: `plan_routes` finds them on tracks, `plan_surface` on the free surface;
`Session.move_on_tracks` and `Session.move_on_surface` carry them out."""

from takt.routing.journey import Journey
from takt.routing.plan import RoutePlan, plan_routes
from takt.routing.streets import RoutingError
from takt.routing.surface import SurfaceLeg, SurfacePlan, plan_surface
from takt.routing.surface_journey import SurfaceJourney

__all__ = [
    "Journey",
    "RoutePlan",
    "RoutingError",
    "SurfaceJourney",
    "SurfaceLeg",
    "SurfacePlan",
    "plan_routes",
    "plan_surface",
]
