"""Routes for many movers at once: `plan_routes` plans them on tracks, `plan_surface` on the free surface;
`Session.move_on_tracks` and `Session.move_on_surface` execute them, and `Session.route` executes a stream of orders."""

from takt.routing.journey import Journey
from takt.routing.plan import RoutePlan, plan_routes
from takt.routing.router import SurfaceOrder, SurfaceRouter
from takt.routing.streets import RoutingError
from takt.routing.surface import SurfaceLeg, SurfacePlan, plan_surface
from takt.routing.surface_journey import SurfaceJourney

__all__ = [
    "Journey",
    "RoutePlan",
    "RoutingError",
    "SurfaceJourney",
    "SurfaceLeg",
    "SurfaceOrder",
    "SurfacePlan",
    "SurfaceRouter",
    "plan_routes",
    "plan_surface",
]
