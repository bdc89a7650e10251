#include "takt/group/params.h"

#include "takt/core/describe.h"
#include "takt/group/commands.h"
#include "takt/group/texts.h"

namespace takt::group {

namespace {

bool FitsShape(bool given, const PathElement& element, ElementShape shape) {
  return given == (element.shape == shape);
}

}  // namespace

void describe(Description<PathLimits>& d) {
  using L = PathLimits;
  d.about("Limits along the path.");
  d.required<&L::velocity>(unit::mm_s, kSpeeds, "Largest speed.");
  d.required<&L::acceleration>(unit::mm_s2, kAccelerations, "Largest acceleration.");
  d.defaulted<&L::deceleration>(unit::mm_s2, kAccelerations, "Largest deceleration; unset: as the acceleration.");
  d.required<&L::jerk>(unit::mm_s3, kJerks, "Largest jerk.");
  d.defaulted<&L::planned_ahead>(
      "Whether paths that stand are planned ahead, as fast as their exact limits allow; false: they are timed as the "
      "mean of a motion whose acceleration may step.");
}

void describe(Description<ToolLimits>& d) {
  using L = ToolLimits;
  d.about("Limits of the tool along X, Y and Z and about them. Unset: none but those of the axes.");
  d.defaulted<&L::velocity>(unit::mm_s, kSpeeds, "Largest velocity along each of X, Y and Z.");
  d.defaulted<&L::acceleration>(unit::mm_s2, kAccelerations, "Largest acceleration along each.");
  d.defaulted<&L::jerk>(unit::mm_s3, kJerks, "Largest jerk along each.");
  d.defaulted<&L::angular_velocity>(unit::deg_s, kSpeeds, "Largest velocity about each of X, Y and Z.");
  d.defaulted<&L::angular_acceleration>(unit::deg_s2, kAccelerations, "Largest acceleration about each.");
  d.defaulted<&L::angular_jerk>(unit::deg_s3, kJerks, "Largest jerk about each.");
}

void describe(Description<JogLimits>& d) {
  using L = JogLimits;
  d.about("The most that jogs may ask for; faster ones are held to it.");
  d.defaulted<&L::velocity>(unit::mm_s, kSpeeds,
                            "Of the tool centre point, also where axes are jogged; unset: as moves.");
  d.defaulted<&L::angular_velocity>(unit::deg_s, kSpeeds, "Of the turn of the tool, likewise; unset: as moves.");
  d.defaulted<&L::axis_factor>(kFactors, "Of the velocity limits of axes that are jogged themselves.");
}

void describe(Enumeration<AfterSync>& e) {
  e.about("What counts once the tool is in step with what moves.");
  e.value(AfterSync::kStay, "stay", "To stay in step, whatever that does; the axes keep their own limits.");
  e.value(AfterSync::kLimited, "limited", "The group's limits: where they do not allow it the tool falls out of step.");
}

void describe(Description<TrackingParams>& d) {
  using P = TrackingParams;
  d.about("How a group follows objects on belts and tables.");
  d.defaulted<&P::after_sync>("Once in step.");
  d.defaulted<&P::tolerance>(at_least(0), "mm, or rad on tables, that count as in step; 0: exactly.");
  d.defaulted<&P::tolerance_time_s>(unit::s, at_least(0), "For so long.");
  d.defaulted<&P::override_in_sync>("The override holds for getting into step, too.");
  d.defaulted<&P::zones_ahead_s>(
      unit::s, between(0, 10),
      "So long beforehand a free zone is taken that the tool is carried into: nobody else goes there then.");
  d.defaulted<&P::board>("From rest onto a belt or table at constant speed by time, while the path begins on it.");
}

void describe(Description<GroupParams>& d) {
  using G = GroupParams;
  d.about("A group of axes that move together, with or without kinematics.");
  d.required<&G::name>("Of the group; commands go to it.");
  d.required<&G::axes>("Names of up to eight axes: those of the kinematics in its order, then auxiliary ones.");
  d.defaulted<&G::kinematics>("How the axes move the tool; unset: there is none, only axes move.");
  d.required<&G::path>("Limits along the path.");
  d.defaulted<&G::tool_limits>("Limits of the tool.");
  d.defaulted<&G::jog>("Limits of jogs.");
  d.defaulted<&G::tracking>("How it follows objects on belts and tables.");
  d.defaulted<&G::base>("Where the machine coordinate system is in the world.");
  d.defaulted<&G::tool>("Where the tool centre point is on the flange.");
  d.defaulted<&G::workspace>(
      "What stands around it and what shapes it has; unset: its paths are not checked for that.");
  d.rule<&G::workspace>("must not be given without kinematics",
                        [](const G& g) { return !g.workspace || g.kinematics; });
  d.rule<&G::axes>("must be 8 names at most", [](const G& g) { return g.axes.size() <= kMaxAxes; });
}

void describe(Description<PathPose>& d) {
  using P = PathPose;
  d.about("A place on a path. What is not given of the orientation is as before.");
  d.required<&P::x>(unit::mm, kPlaces, "X.");
  d.required<&P::y>(unit::mm, kPlaces, "Y.");
  d.required<&P::z>(unit::mm, kPlaces, "Z.");
  d.defaulted<&P::a>(unit::deg, kAngles, "Turned about X.");
  d.defaulted<&P::b>(unit::deg, kAngles, "Turned about Y.");
  d.defaulted<&P::c>(unit::deg, kAngles, "Turned about Z.");
}

void describe(Enumeration<ElementShape>& e) {
  e.about("What an element of a path is.");
  e.value(ElementShape::kLine, "line", "A straight line.");
  e.value(ElementShape::kArc, "arc", "A part of a circle, through a point on the way.");
  e.value(ElementShape::kSpline, "spline", "A smooth curve through points.");
}

void describe(Description<PathElement>& d) {
  using E = PathElement;
  d.about("An element of a path; it begins where the one before it ends.");
  d.required<&E::shape>("What it is.");
  d.defaulted<&E::to>("Where it ends; of lines and arcs.");
  d.defaulted<&E::via_x>(unit::mm, kPlaces, "X of a point on the way; of arcs.");
  d.defaulted<&E::via_y>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&E::via_z>(unit::mm, kPlaces, "Z of it.");
  d.defaulted<&E::points>("What a spline goes through, its end last; of a path's first element its beginning first.");
  d.defaulted<&E::velocity>(unit::mm_s, kSpeeds, "Largest speed on it; unset: that of the command.");
  d.rule<&E::to>("must be given for a line and an arc, and for no spline",
                 [](const E& e) { return FitsShape(!e.to, e, ElementShape::kSpline); });
  d.rule<&E::via_x>("must be given for an arc, together with via_y and via_z, and for nothing else", [](const E& e) {
    return FitsShape(e.via_x.has_value(), e, ElementShape::kArc) && e.via_x.has_value() == e.via_y.has_value() &&
           e.via_x.has_value() == e.via_z.has_value();
  });
  d.rule<&E::points>("must be given for a spline, and for nothing else",
                     [](const E& e) { return FitsShape(!e.points.empty(), e, ElementShape::kSpline); });
}

void describe(Description<ZoneCorner>& d) {
  d.about("A corner of a zone, in the world.");
  d.required<&ZoneCorner::x>(unit::mm, kPlaces, "X.");
  d.required<&ZoneCorner::y>(unit::mm, kPlaces, "Y.");
  d.required<&ZoneCorner::z>(unit::mm, kPlaces, "Z.");
}

void describe(Description<ZoneParams>& d) {
  using Z = ZoneParams;
  d.about("A box that groups share: the tool of one of them is inside at a time, the others wait outside.");
  d.required<&Z::name>("How it is called.");
  d.defaulted<&Z::groups>("Names of the groups that share it; none: all groups.");
  d.required<&Z::lower>("Its corner with the least coordinates.");
  d.required<&Z::upper>("Its corner with the greatest ones.");
  d.defaulted<&Z::margin>(unit::mm, kLengths, "So much around it counts as inside: what grippers and workpieces need.");
  d.rule<&Z::upper>("must lie above lower in X, Y and Z",
                    [](const Z& z) { return z.lower.x < z.upper.x && z.lower.y < z.upper.y && z.lower.z < z.upper.z; });
}

void describe(Description<PathParams>& d) {
  using P = PathParams;
  d.about("A path for groups of axes: lines, arcs and splines, one behind the other.");
  d.required<&P::name>("How commands call it.");
  d.defaulted<&P::file>(
      "A CSV file of elements instead, beside the machine file: columns x, y, z and perhaps shape, a, b, c, via_x, "
      "via_y, via_z, velocity. Lines of shape spline that follow one another are the points of one spline.");
  d.defaulted<&P::elements>("The elements. The first one begins where the group is, unless it is a spline.");
  d.rule<&P::elements>("must be given, or a file", [](const P& p) { return !p.elements.empty() || !p.file.empty(); });
  d.rule<&P::file>("must not be given besides elements",
                   [](const P& p) { return p.elements.empty() || p.file.empty(); });
}

}  // namespace takt::group
