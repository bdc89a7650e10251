#include "takt/environment/commands.h"

#include "takt/core/describe.h"

namespace takt::environment {

namespace {

constexpr Range kPlaces = between(-1e6, 1e6);  // [mm]

}  // namespace

void describe(Description<AddStator>& d) {
  d.about(
      "Adds a stator of 240 mm by 240 mm, which takes effect when the boundary is created. Refused in an enabled "
      "group, or while the boundary is being made.");
  d.required<&AddStator::lower_x>(unit::mm, kPlaces, "X of its lower left corner.");
  d.required<&AddStator::lower_y>(unit::mm, kPlaces, "Y of its lower left corner.");
}

void describe(Description<CreateBoundary>& d) {
  d.about(
      "Creates the boundary around all stators; done some cycles later. Refused in an enabled group, or while the "
      "boundary is being made.");
}

void describe(Description<Clear>& d) {
  d.named("ClearEnvironment");
  d.about("Removes all stators and the boundary. Refused in an enabled group, or while the boundary is being made.");
}

void describe(Description<AddToGroup>& d) {
  d.named("AddEnvironmentToGroup");
  d.about("Adds the environment to a group of movers, which must not cross its border from then on.");
  d.required<&AddToGroup::group>("Name of the group.");
}

void describe(Description<RemoveFromGroup>& d) {
  d.named("RemoveEnvironmentFromGroup");
  d.about("Removes the environment from its group, whose movers are then no longer checked against its border.");
}

void describe(Description<BoundaryMade>& d) {
  using C = BoundaryMade;
  d.about("Answer to a request to build a boundary.");
  d.required<&C::number>("Number of the request.");
  d.defaulted<&C::problem>("Why there is no boundary.");
  d.defaulted<&C::stator>("Stator with the problem, from 1; 0: none.");
}

}  // namespace takt::environment
