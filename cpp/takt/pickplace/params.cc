#include "takt/pickplace/params.h"

#include "takt/core/describe.h"
#include "takt/core/scalar.h"

namespace takt::pickplace {

std::string DiagnoseBelt(std::uint32_t belt, std::size_t belts, std::string_view none) {
  const bool may_be_none = belt != 0 && !none.empty();
  if (belt <= belts && (belt != 0 || !none.empty())) return {};
  const std::string zero = may_be_none ? "0, " + std::string(none) : std::string();
  const std::string found = ", found " + std::to_string(belt);
  if (belts == 0) return "expected " + (zero.empty() ? "a belt" : zero) + ": the module's list has no belts" + found;
  const std::string numbers = belts == 1 ? "1" : "1 to " + std::to_string(belts);
  return "expected a belt of the module's list, " + numbers + (zero.empty() ? "" : ", or " + zero) + found;
}

std::string DiagnoseMode(TrackingMode mode, std::size_t belts) {
  const bool both = mode == TrackingMode::kBelt1ToBelt2 || mode == TrackingMode::kBelt2ToBelt1;
  const bool one = mode == TrackingMode::kStaticToBelt1 || mode == TrackingMode::kBelt1ToStatic;
  const std::size_t needed = both ? 2 : one ? 1 : 0;
  if (needed <= belts) return {};
  return "expected a mode for the belts of the module's list, found one that needs belt " + std::to_string(needed) +
         " where there " + (belts == 1 ? "is 1" : "is none");
}

std::string DiagnoseRange(const BeltSettings& settings, const conveyor::BeltParams& belt) {
  if (RangeMeets(settings, belt)) return {};
  const auto limit = [](const std::optional<double>& value, const char* none) {
    return value ? FormatReal(*value) : std::string(none);
  };
  return "expected lower_limit to upper_limit to overlap the work range of belt '" + belt.name + "', " +
         limit(belt.lower_limit, "any") + " to " + limit(belt.upper_limit, "any") + ", found " +
         FormatReal(settings.lower_limit) + " to " + FormatReal(settings.upper_limit);
}

std::string DiagnoseLeave(const BeltSettings& settings, const conveyor::BeltParams& belt) {
  if (LeaveMeets(settings, belt)) return {};
  return "expected 0, or an upper_limit below that of belt '" + belt.name + "', " + FormatReal(*belt.upper_limit) +
         ", found leave " + std::to_string(settings.leave) + " with upper_limit " + FormatReal(settings.upper_limit);
}

void describe(Description<PickPlaceBelt>& d) {
  d.about("A belt as a pick and place module uses it.");
  d.required<&PickPlaceBelt::belt>("Name of the belt.");
  d.defaulted<&PickPlaceBelt::settings>("Initial settings for the belt.");
}

void describe(Description<AxisHoming>& d) {
  d.named("PickPlaceHoming");
  d.about("Homing of an axis if the setting home_by_module is true.");
  d.required<&AxisHoming::axis>("Name of an axis of the group.");
  d.required<&AxisHoming::homing>("Parameters of its homing.");
}

void describe(Description<PickPlaceParams>& d) {
  using P = PickPlaceParams;
  d.about("A pick and place module: it moves a group between static targets and workpieces on belts.");
  d.required<&P::name>("Name of the module, to which commands are addressed.");
  d.required<&P::group>("Name of the group that it moves.");
  d.defaulted<&P::belts>("Belts from which it picks and onto which it places, in the order of their numbers.");
  d.defaulted<&P::settings>("Initial settings.");
  d.defaulted<&P::homing>("Homing of axes that differs from their own.");
  d.rule<&P::settings>("workpiece_pcs1 and workpiece_pcs2 must be different: places on two belts are seen from them",
                       [](const P& p) { return WorkpieceSystemsFit(p.settings); });
  d.rule<&P::settings>(
      "target_pcs must be another one than workpiece_pcs1 and workpiece_pcs2: the target would lie on a workpiece",
      [](const P& p) { return p.belts.empty() || TargetSystemFits(p.settings); });
  d.rule<&P::belts>("must be no more than 16", [](const P& p) { return p.belts.size() <= kBelts; });
}

}  // namespace takt::pickplace
