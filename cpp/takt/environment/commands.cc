#include "takt/environment/commands.h"

#include "takt/core/describe.h"

namespace takt::environment {

namespace {

constexpr Range kPlaces = between(-1e6, 1e6);  // [mm]

}  // namespace

void describe(Description<AddStator>& d) {
  d.about("Adds a stator of 240 mm by 240 mm. It counts once the boundary is created.");
  d.required<&AddStator::lower_x>(unit::mm, kPlaces, "X of its lower left corner.");
  d.required<&AddStator::lower_y>(unit::mm, kPlaces, "Y of it.");
}

void describe(Description<CreateBoundary>& d) {
  d.about("Creates the boundary around the stators that there are; done some cycles later.");
}

void describe(Description<Clear>& d) {
  d.named("ClearEnvironment");
  d.about("Takes all stators and the boundary away.");
}

void describe(Description<AddToGroup>& d) {
  d.named("AddEnvironmentToGroup");
  d.about("Puts the environment into a group of movers: they do not cross its border any more.");
  d.required<&AddToGroup::group>("Name of the group.");
}

void describe(Description<RemoveFromGroup>& d) {
  d.named("RemoveEnvironmentFromGroup");
  d.about("Takes the environment out of its group: nobody looks for its border any more.");
}

void describe(Description<BoundaryMade>& d) {
  using C = BoundaryMade;
  d.about("Tells whether a boundary could be made.");
  d.required<&C::number>("Of the question.");
  d.defaulted<&C::problem>("Why there is none.");
  d.defaulted<&C::stator>("With which stator the problem is, from 1; 0: with none.");
}

}  // namespace takt::environment
