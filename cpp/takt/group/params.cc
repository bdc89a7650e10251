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
      "Whether paths that are not on a carrier are planned ahead, up to their exact limits; false: they are timed as "
      "the mean of a motion whose acceleration may step.");
}

void describe(Description<ToolLimits>& d) {
  using L = ToolLimits;
  d.about("Limits of the tool along and about X, Y and Z of the world. Unset: only the limits of the axes apply.");
  d.defaulted<&L::velocity>(unit::mm_s, kSpeeds, "Largest velocity along each of X, Y and Z.");
  d.defaulted<&L::acceleration>(unit::mm_s2, kAccelerations, "Largest acceleration along each.");
  d.defaulted<&L::jerk>(unit::mm_s3, kJerks, "Largest jerk along each.");
  d.defaulted<&L::angular_velocity>(unit::deg_s, kSpeeds, "Largest velocity about each of X, Y and Z.");
  d.defaulted<&L::angular_acceleration>(unit::deg_s2, kAccelerations, "Largest acceleration about each.");
  d.defaulted<&L::angular_jerk>(unit::deg_s3, kJerks, "Largest jerk about each.");
}

void describe(Description<JogLimits>& d) {
  using L = JogLimits;
  d.about("Upper limits of jogs; faster jogs are limited to them.");
  d.defaulted<&L::velocity>(
      unit::mm_s, kSpeeds, "Largest speed of the tool centre point, also while axes are jogged; unset: that of moves.");
  d.defaulted<&L::angular_velocity>(unit::deg_s, kSpeeds,
                                    "Largest angular speed of the tool, likewise; unset: that of moves.");
  d.defaulted<&L::axis_factor>(kFactors, "Factor of the velocity limits of jogged axes.");
}

void describe(Enumeration<AfterSync>& e) {
  e.about("Limits that apply once the tool is in sync with a moving object.");
  e.value(AfterSync::kStay, "stay", "The tool stays in sync, within the limits of the axes only.");
  e.value(AfterSync::kLimited, "limited",
          "The group's limits apply: where they do not suffice the tool falls out of sync.");
}

void describe(Description<TrackingParams>& d) {
  using P = TrackingParams;
  d.about("Tracking of objects on belts and tables.");
  d.defaulted<&P::after_sync>("Limits that apply once in sync.");
  d.defaulted<&P::tolerance>(
      at_least(0), "Largest lag that counts as in sync: mm, or rad on tables, and the unit of each axis; 0: none.");
  d.defaulted<&P::tolerance_time_s>(unit::s, at_least(0), "Time for which the lag must stay within the tolerance.");
  d.defaulted<&P::override_in_sync>("The override also scales the velocity of getting into sync.");
  d.defaulted<&P::zones_ahead_s>(
      unit::s, between(0, 10),
      "Time before the tool is carried into a free zone at which the zone is reserved for the group.");
  d.defaulted<&P::board>(
      "From rest onto a belt or table at constant speed, the tool gets into sync by time while it already moves along "
      "the path.");
}

void describe(Description<GroupParams>& d) {
  using G = GroupParams;
  d.about("A group of axes that move together, with or without kinematics.");
  d.required<&G::name>("Name of the group, to which commands are addressed.");
  d.required<&G::axes>("Names of up to eight axes: those of the kinematics in its order, then auxiliary ones.");
  d.defaulted<&G::kinematics>("Kinematics that move the tool; unset: none, only axes move.");
  d.required<&G::path>("Limits along the path.");
  d.defaulted<&G::tool_limits>("Limits of the tool.");
  d.defaulted<&G::jog>("Limits of jogs.");
  d.defaulted<&G::tracking>("Tracking of objects on belts and tables.");
  d.defaulted<&G::base>("Pose of the machine coordinate system in the world.");
  d.defaulted<&G::tool>("Pose of the tool centre point on the flange.");
  d.defaulted<&G::workspace>(
      "Obstacles around the group and shapes of its parts; unset: paths are not checked for collisions.");
  d.rule<&G::workspace>("must not be given without kinematics",
                        [](const G& g) { return !g.workspace || g.kinematics; });
  d.rule<&G::axes>("must be 8 names at most", [](const G& g) { return g.axes.size() <= kMaxAxes; });
}

void describe(Description<PathPose>& d) {
  using P = PathPose;
  d.about("A pose on a path. Unset angles keep their previous values.");
  d.required<&P::x>(unit::mm, kPlaces, "X.");
  d.required<&P::y>(unit::mm, kPlaces, "Y.");
  d.required<&P::z>(unit::mm, kPlaces, "Z.");
  d.defaulted<&P::a>(unit::deg, kAngles, "Rotation about X.");
  d.defaulted<&P::b>(unit::deg, kAngles, "Rotation about Y.");
  d.defaulted<&P::c>(unit::deg, kAngles, "Rotation about Z.");
}

void describe(Enumeration<ElementShape>& e) {
  e.about("Shape of an element of a path.");
  e.value(ElementShape::kLine, "line", "A straight line.");
  e.value(ElementShape::kArc, "arc", "A circular arc through a given point.");
  e.value(ElementShape::kSpline, "spline", "A smooth curve through points.");
}

void describe(Description<PathElement>& d) {
  using E = PathElement;
  d.about("An element of a path; it begins where the one before it ends.");
  d.required<&E::shape>("Shape of the element.");
  d.defaulted<&E::to>("End of the element; lines and arcs only.");
  d.defaulted<&E::via_x>(unit::mm, kPlaces, "X of a point on the arc; arcs only.");
  d.defaulted<&E::via_y>(unit::mm, kPlaces, "Y of that point.");
  d.defaulted<&E::via_z>(unit::mm, kPlaces, "Z of that point.");
  d.defaulted<&E::points>("Points of a spline, its end last; as the first element of a path its start first.");
  d.defaulted<&E::velocity>(unit::mm_s, kSpeeds, "Largest speed on the element; unset: that of the command.");
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
  d.about("A box shared by groups: the tool of only one of them is inside at a time, the others wait outside.");
  d.required<&Z::name>("Name of the zone.");
  d.defaulted<&Z::groups>("Names of the groups that share the zone; none: all groups.");
  d.required<&Z::lower>("Corner with the smallest coordinates.");
  d.required<&Z::upper>("Corner with the largest coordinates.");
  d.defaulted<&Z::margin>(unit::mm, kLengths,
                          "Distance around the box that counts as inside, for grippers and workpieces.");
  d.rule<&Z::upper>("must lie above lower in X, Y and Z",
                    [](const Z& z) { return z.lower.x < z.upper.x && z.lower.y < z.upper.y && z.lower.z < z.upper.z; });
}

void describe(Description<PathParams>& d) {
  using P = PathParams;
  d.about("A path for groups of axes: consecutive lines, arcs and splines.");
  d.required<&P::name>("Name by which commands select the path.");
  d.defaulted<&P::file>(
      "CSV file of elements, relative to the machine file, instead of elements: columns x, y, z and optionally shape, "
      "a, b, c, via_x, via_y, via_z, velocity. Consecutive lines of shape spline are the points of one spline.");
  d.defaulted<&P::elements>(
      "Elements of the path. The first one starts at the present pose of the group, unless it is a spline.");
  d.rule<&P::elements>("must be given, or a file", [](const P& p) { return !p.elements.empty() || !p.file.empty(); });
  d.rule<&P::file>("must not be given besides elements",
                   [](const P& p) { return p.elements.empty() || p.file.empty(); });
}

}  // namespace takt::group
