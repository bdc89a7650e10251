#include "takt/group/commands.h"

#include <string_view>

#include "takt/group/texts.h"

namespace takt::group {

namespace {

template <typename T>
void DescribeNumbers(Description<T>& d) {
  d.template defaulted<&T::x>(unit::mm, kPlaces, "X of the tool; x to c are not allowed in ACS.");
  d.template defaulted<&T::y>(unit::mm, kPlaces, "Y of the tool.");
  d.template defaulted<&T::z>(unit::mm, kPlaces, "Z of the tool.");
  d.template defaulted<&T::a>(unit::deg, kAngles, "Rotation about X.");
  d.template defaulted<&T::b>(unit::deg, kAngles, "Rotation about Y.");
  d.template defaulted<&T::c>(unit::deg, kAngles, "Rotation about Z.");
  d.template defaulted<&T::a1>(unit::u, kAxisPositions, "Axis 1; in ACS any axis, else only auxiliary axes.");
  d.template defaulted<&T::a2>(unit::u, kAxisPositions, "Axis 2.");
  d.template defaulted<&T::a3>(unit::u, kAxisPositions, "Axis 3.");
  d.template defaulted<&T::a4>(unit::u, kAxisPositions, "Axis 4.");
  d.template defaulted<&T::a5>(unit::u, kAxisPositions, "Axis 5.");
  d.template defaulted<&T::a6>(unit::u, kAxisPositions, "Axis 6.");
  d.template defaulted<&T::a7>(unit::u, kAxisPositions, "Axis 7.");
  d.template defaulted<&T::a8>(unit::u, kAxisPositions, "Axis 8.");
}

template <typename T>
void DescribeSystem(Description<T>& d) {
  d.template defaulted<&T::coordinate_system>("Coordinate system of the values (CoordSystem).");
  d.template defaulted<&T::pcs>(between(1, kProductSystems), "Number of the product coordinate system, with pcs.");
}

template <typename T>
void DescribeRamps(Description<T>& d) {
  d.template defaulted<&T::velocity>(unit::mm_s, kSpeeds, "Largest speed along the path; unset: the group's limit.");
  d.template defaulted<&T::acceleration>(unit::mm_s2, kAccelerations,
                                         "Largest acceleration along the path; unset: the group's limit.");
  d.template defaulted<&T::deceleration>(unit::mm_s2, kAccelerations,
                                         "Largest deceleration along the path; unset: the group's limit.");
  d.template defaulted<&T::jerk>(unit::mm_s3, kJerks, "Largest jerk along the path; unset: the group's limit.");
}

template <typename T>
void DescribeTransition(Description<T>& d, std::string_view mode) {
  d.template defaulted<&T::transition_mode>(mode);
  d.template defaulted<&T::transition_parameter>(
      between(0, 1e9),
      "TransitionParameter: by mode the distance from the corner in mm, the deviation in mm, or the speed in mm/s.");
}

constexpr std::string_view kIntoThis = "Transition from the previous move, with a blending buffer mode.";

template <typename T>
void DescribeBuffering(Description<T>& d) {
  d.template defaulted<&T::buffer_mode>("Start of the move relative to the previous one.");
  DescribeTransition(d, kIntoThis);
}

template <Reference kReference>
void DescribeLinear(Description<MoveLinear<kReference>>& d) {
  DescribeNumbers(d);
  DescribeSystem(d);
  DescribeRamps(d);
  DescribeBuffering(d);
}

template <Reference kReference>
void DescribeCircular(Description<MoveCircular<kReference>>& d) {
  using M = MoveCircular<kReference>;
  d.template defaulted<&M::circ_mode>("Definition of the circle (CircMode).");
  d.template defaulted<&M::aux_x>(unit::mm, kPlaces, "X of AuxPoint: a point on the arc, the centre, or a vector.");
  d.template defaulted<&M::aux_y>(unit::mm, kPlaces, "Y of AuxPoint.");
  d.template defaulted<&M::aux_z>(unit::mm, kPlaces, "Z of AuxPoint.");
  d.template defaulted<&M::path_choice>(
      "Choice between several arcs (PathChoice); no effect if a point on the arc is given.");
  d.template defaulted<&M::normal_x>(
      kPlaces, "X of the normal of the plane, of any length, with a centre; all 0: the normal with Z above 0.");
  d.template defaulted<&M::normal_y>(kPlaces, "Y of the normal.");
  d.template defaulted<&M::normal_z>(kPlaces, "Z of the normal.");
  d.template defaulted<&M::turns>(at_most(path::kMostTurns), "Additional whole turns.");
  DescribeNumbers(d);
  DescribeSystem(d);
  DescribeRamps(d);
  DescribeBuffering(d);
}

template <Reference kReference>
void DescribeDirect(Description<MoveDirect<kReference>>& d) {
  using M = MoveDirect<kReference>;
  DescribeNumbers(d);
  DescribeSystem(d);
  d.template defaulted<&M::shoulder>(
      "Configuration of the shoulder, for a pose. Keep, here and below: of all configurations and turns within the "
      "axes' ranges, the one that the axes reach first.");
  d.template defaulted<&M::elbow>("Configuration of the elbow, for a pose.");
  d.template defaulted<&M::wrist>("Configuration of the wrist, for a pose.");
  d.template defaulted<&M::velocity_factor>(kFactors, "Factor of the axes' velocity limits.");
  d.template defaulted<&M::acceleration_factor>(kFactors, "Factor of the axes' acceleration limits.");
  d.template defaulted<&M::jerk_factor>(kFactors, "Factor of the axes' jerk limits.");
  DescribeBuffering(d);
}

template <typename T>
void DescribeBrake(Description<T>& d) {
  d.template defaulted<&T::deceleration>(unit::mm_s2, kAccelerations, "Largest deceleration; unset: that of the move.");
  d.template defaulted<&T::jerk>(unit::mm_s3, kJerks,
                                 "Largest jerk; unset: that of the move. A lower jerk also lowers the deceleration.");
}

template <typename T>
void DescribePose(Description<T>& d) {
  d.template defaulted<&T::x>(unit::mm, kPlaces, "X of the pose.");
  d.template defaulted<&T::y>(unit::mm, kPlaces, "Y of the pose.");
  d.template defaulted<&T::z>(unit::mm, kPlaces, "Z of the pose.");
  d.template defaulted<&T::a>(unit::deg, kAngles, "Rotation about X.");
  d.template defaulted<&T::b>(unit::deg, kAngles, "Rotation about Y.");
  d.template defaulted<&T::c>(unit::deg, kAngles, "Rotation about Z.");
}

}  // namespace

void describe(Enumeration<CoordinateSystem>& e) {
  e.about("Coordinate system of given values.");
  e.value(CoordinateSystem::kAcs, "acs", "Axes: a1 to a8, each in its own unit.");
  e.value(CoordinateSystem::kMcs, "mcs", "The machine coordinate system, that of the kinematics.");
  e.value(CoordinateSystem::kWcs, "wcs",
          "The world coordinate system, in which `base` of the group is the pose of the machine coordinate system.");
  e.value(CoordinateSystem::kPcs, "pcs", "One of 16 product coordinate systems, see set_cartesian_transform.");
}

void describe(Enumeration<TransitionMode>& e) {
  e.about("Transition from one move to the next.");
  e.value(TransitionMode::kNone, "none", "Through the corner itself.");
  e.value(TransitionMode::kStartVelocity, "start_velocity",
          "Rounded from where braking from the given speed would begin.");
  e.value(TransitionMode::kConstantVelocity, "constant_velocity",
          "Rounded by the shortest blend on which the given speed can be kept.");
  e.value(TransitionMode::kCornerDistance, "corner_distance", "Rounded from the given distance before the corner on.");
  e.value(TransitionMode::kMaxCornerDeviation, "max_corner_deviation",
          "Rounded, at most the given distance from the corner.");
}

void describe(Description<MoveLinearAbsolute>& d) {
  d.named("MoveLinearAbsolute");
  d.about(
      "Moves in a straight line to a target (MC_MoveLinearAbsolute). Coordinates that are not given keep their "
      "values.");
  DescribeLinear(d);
}

void describe(Description<MoveLinearRelative>& d) {
  d.named("MoveLinearRelative");
  d.about("Moves in a straight line by a displacement from the end of the previous move (MC_MoveLinearRelative).");
  DescribeLinear(d);
}

void describe(Description<MoveCircularAbsolute>& d) {
  d.named("MoveCircularAbsolute");
  d.about(
      "Moves along a circle or a helix to a target (MC_MoveCircularAbsolute). Coordinates that are not given keep "
      "their values.");
  DescribeCircular(d);
}

void describe(Description<MoveCircularRelative>& d) {
  d.named("MoveCircularRelative");
  d.about(
      "Moves along a circle or a helix by a displacement (MC_MoveCircularRelative). Points also count from its start.");
  DescribeCircular(d);
}

void describe(Description<MoveDirectAbsolute>& d) {
  d.named("MoveDirectAbsolute");
  d.about(
      "Moves all axes to a target, without a given path, so that they arrive together (MC_MoveDirectAbsolute). "
      "Coordinates that are not given keep their values.");
  DescribeDirect(d);
}

void describe(Description<MoveDirectRelative>& d) {
  d.named("MoveDirectRelative");
  d.about("Moves all axes by a displacement, so that they arrive together (MC_MoveDirectRelative).");
  DescribeDirect(d);
}

void describe(Description<MoveArch>& d) {
  d.about("Moves the tool along half an ellipse, upright in the world over its start and end.");
  DescribeNumbers(d);
  d.defaulted<&MoveArch::height>(unit::mm, kLengths, "Height of the crest above the higher of start and end.");
  DescribeSystem(d);
  DescribeRamps(d);
  DescribeBuffering(d);
}

void describe(Description<MovePath>& d) {
  using M = MovePath;
  d.about("Moves along a path of the machine file (MC_PathSelect, MC_MovePath).");
  d.required<&M::path>("Name of the path.");
  DescribeSystem(d);
  DescribeRamps(d);
  d.defaulted<&M::buffer_mode>("Start of the move relative to the previous one.");
  DescribeTransition(d, "Transition at the corners of the path, and into the path with a blending buffer mode.");
}

void describe(Description<MovePathSynchronized>& d) {
  using M = MovePathSynchronized;
  d.about(
      "Moves along a path of the machine file in sync with a master axis (MC_MovePathSynchronized). Limits are kept: a "
      "lag is made up later.");
  d.required<&M::path>("Name of the path.");
  d.required<&M::master>("Name of the master axis.");
  d.defaulted<&M::ratio>(unit::mm_u_m, between(-1e9, 1e9),
                         "Displacement along the path per displacement of the master, not 0.");
  DescribeSystem(d);
  DescribeRamps(d);
  DescribeTransition(d, "Transition at the corners of the path.");
}

void describe(Description<SyncAxis>& d) {
  using C = SyncAxis;
  d.about(
      "Lets an axis that is not a member follow the arc length of the path (MC_SyncAxisToGroup), until it gets a "
      "command of its own.");
  d.required<&C::axis>("Name of the axis.");
  d.defaulted<&C::ratio_numerator>(unit::u, between(-1e9, 1e9), "Displacement of the axis ...");
  d.defaulted<&C::ratio_denominator>(unit::mm, between(-1e9, 1e9), "... per displacement along the path, not 0.");
}

void describe(Enumeration<JogSystem>& e) {
  e.about("Coordinate system of the directions of a jog.");
  e.value(JogSystem::kAcs, "acs", "The axes.");
  e.value(JogSystem::kMcs, "mcs", "The machine coordinate system.");
  e.value(JogSystem::kWcs, "wcs", "The world.");
  e.value(JogSystem::kPcs, "pcs", "A product coordinate system, as it is when the jog begins.");
  e.value(JogSystem::kTool, "tool", "The tool, in its orientation when the jog begins.");
}

void describe(Description<Jog>& d) {
  d.named("GroupJog");
  d.about(
      "Moves at these speeds while it is held. Ends with an error at the border of what can be reached; the opposite "
      "direction is possible from there. A further jog in the same direction changes the speed, in another direction "
      "it starts from rest; all 0, or a release, ends it: done when the group is at rest.");
  d.defaulted<&Jog::x>(unit::mm_s, kJogSpeeds, "Speed of the tool along X; x to c are not allowed in ACS.");
  d.defaulted<&Jog::y>(unit::mm_s, kJogSpeeds, "Speed along Y.");
  d.defaulted<&Jog::z>(unit::mm_s, kJogSpeeds, "Speed along Z.");
  d.defaulted<&Jog::a>(unit::deg_s, kJogSpeeds, "Angular speed of the tool about X, through the tool centre point.");
  d.defaulted<&Jog::b>(unit::deg_s, kJogSpeeds, "Angular speed about Y.");
  d.defaulted<&Jog::c>(unit::deg_s, kJogSpeeds, "Angular speed about Z.");
  d.defaulted<&Jog::a1>(unit::u_s, kJogSpeeds, "Speed of axis 1; in ACS any axis, else only auxiliary axes.");
  d.defaulted<&Jog::a2>(unit::u_s, kJogSpeeds, "Speed of axis 2.");
  d.defaulted<&Jog::a3>(unit::u_s, kJogSpeeds, "Speed of axis 3.");
  d.defaulted<&Jog::a4>(unit::u_s, kJogSpeeds, "Speed of axis 4.");
  d.defaulted<&Jog::a5>(unit::u_s, kJogSpeeds, "Speed of axis 5.");
  d.defaulted<&Jog::a6>(unit::u_s, kJogSpeeds, "Speed of axis 6.");
  d.defaulted<&Jog::a7>(unit::u_s, kJogSpeeds, "Speed of axis 7.");
  d.defaulted<&Jog::a8>(unit::u_s, kJogSpeeds, "Speed of axis 8.");
  d.defaulted<&Jog::coordinate_system>("Coordinate system of the directions.");
  d.defaulted<&Jog::pcs>(between(1, kProductSystems), "Number of the product coordinate system, with pcs.");
  d.defaulted<&Jog::acceleration>(unit::mm_s2, kAccelerations,
                                  "Largest acceleration along the path; unset: the group's limit.");
  d.defaulted<&Jog::deceleration>(unit::mm_s2, kAccelerations,
                                  "Largest deceleration along the path; unset: the group's limit.");
  d.defaulted<&Jog::jerk>(unit::mm_s3, kJerks, "Largest jerk along the path; unset: the group's limit.");
}

void describe(Description<Stream>& d) {
  using C = Stream;
  d.named("GroupStream");
  d.about(
      "Follows external set points, given one by one with stream_point, at 20 Hz up to once per cycle. Each axis "
      "follows a smooth curve through them, within its limits. Reached when all axes are on their curves. Takes over "
      "from moves and streams without a stop. Ends with error 3123 and a stop within limits when no set point has "
      "arrived for the timeout.");
  d.defaulted<&C::key>(
      "Number that the set points must carry: choose your own, so that set points of other clients are refused.");
  d.defaulted<&C::delay>(unit::s, between(0, 10),
                         "Time from the arrival of the first set point until it is due, the others by their times: it "
                         "covers jitter and losses.");
  d.defaulted<&C::timeout>(unit::s, between(0.001, 60), "Longest time without a set point, from the first one on.");
  d.defaulted<&C::velocity_factor>(kFactors,
                                   "Factor of the axes' velocity limits for catching up with the set points.");
  d.defaulted<&C::acceleration_factor>(kFactors, "Factor of their acceleration limits, likewise.");
  d.defaulted<&C::jerk_factor>(kFactors, "Factor of their jerk limits, likewise.");
}

void describe(Description<StreamPoint>& d) {
  using C = StreamPoint;
  d.named("GroupStreamPoint");
  d.about(
      "A set point of the active stream. Coordinates that are not given keep the values of the previous set point. "
      "Refused without ending the stream: a key of another stream (3120), a time that has passed or has a set point "
      "(3121), a distance from the previous set point that the axes cannot move in the time between them (3122), a "
      "position beyond a SW limit (8), a pose that cannot be reached (3021, 3022), a zone of another group (3130), a "
      "product coordinate system that moves (5).");
  DescribeNumbers(d);
  d.defaulted<&C::vx>(unit::mm_s, kJogSpeeds,
                      "Velocity of the tool along X. If any of vx to wz is given, the others are 0; else they follow "
                      "from the neighbouring set points.");
  d.defaulted<&C::vy>(unit::mm_s, kJogSpeeds, "Velocity of the tool along Y.");
  d.defaulted<&C::vz>(unit::mm_s, kJogSpeeds, "Velocity of the tool along Z.");
  d.defaulted<&C::wx>(unit::deg_s, kJogSpeeds, "Angular velocity of the tool about X, through the tool centre point.");
  d.defaulted<&C::wy>(unit::deg_s, kJogSpeeds, "Angular velocity about Y.");
  d.defaulted<&C::wz>(unit::deg_s, kJogSpeeds, "Angular velocity about Z.");
  d.defaulted<&C::v1>(unit::u_s, kJogSpeeds, "Velocity of axis 1; unset: from the neighbouring set points.");
  d.defaulted<&C::v2>(unit::u_s, kJogSpeeds, "Velocity of axis 2.");
  d.defaulted<&C::v3>(unit::u_s, kJogSpeeds, "Velocity of axis 3.");
  d.defaulted<&C::v4>(unit::u_s, kJogSpeeds, "Velocity of axis 4.");
  d.defaulted<&C::v5>(unit::u_s, kJogSpeeds, "Velocity of axis 5.");
  d.defaulted<&C::v6>(unit::u_s, kJogSpeeds, "Velocity of axis 6.");
  d.defaulted<&C::v7>(unit::u_s, kJogSpeeds, "Velocity of axis 7.");
  d.defaulted<&C::v8>(unit::u_s, kJogSpeeds, "Velocity of axis 8.");
  DescribeSystem(d);
  d.defaulted<&C::time>(unit::s, between(-1e12, 1e12), "Time by a steady clock of the sender; unset: time of arrival.");
  d.defaulted<&C::key>("Key of the stream.");
}

void describe(Description<Stop>& d) {
  d.about("Brakes to standstill on the path; no other motion may take over until it is released (MC_GroupStop).");
  DescribeBrake(d);
  d.defaulted<&Stop::hold>("True: stay in GroupStopping until released (Execute kept true). False: until at rest.");
}

void describe(Description<Halt>& d) {
  d.about("Brakes to standstill on the path; another move may take over meanwhile (MC_GroupHalt).");
  DescribeBrake(d);
}

void describe(Description<Interrupt>& d) {
  d.about("Brakes to standstill on the path, from where continue_path resumes it (MC_GroupInterrupt).");
  DescribeBrake(d);
}

void describe(Description<Continue>& d) {
  d.about("Resumes the path that was interrupted (MC_GroupContinue).");
}

void describe(Description<AddAxis>& d) {
  d.about("Adds an axis to a group that is not enabled (MC_AddAxisToGroup).");
  d.required<&AddAxis::axis>("Name of the axis.");
  d.defaulted<&AddAxis::ident>(between(1, kMaxAxes), "Number of the axis in the group (IdentInGroup): 1 is a1.");
}

void describe(Description<RemoveAxis>& d) {
  d.about("Removes an axis from a group that is not enabled (MC_RemoveAxisFromGroup).");
  d.defaulted<&RemoveAxis::ident>(between(1, kMaxAxes), "Number of the axis in the group (IdentInGroup).");
}

void describe(Description<UngroupAllAxes>& d) {
  d.about("Removes all axes from the group, which is then disabled (MC_UngroupAllAxes).");
}

void describe(Description<Enable>& d) {
  d.about("Enables the group: from GroupDisabled to GroupStandby (MC_GroupEnable).");
}

void describe(Description<Disable>& d) {
  d.about("Disables the group; its axes take commands of their own again (MC_GroupDisable).");
}

void describe(Description<Reset>& d) {
  d.about("Clears the faults of the group and of its axes and leaves GroupErrorStop (MC_GroupReset).");
}

void describe(Description<Power>& d) {
  d.about("Switches the drives of all axes of the group on or off (MC_Power of each).");
  d.defaulted<&Power::enable>("True: on. False: off; a moving group stops first.");
}

void describe(Description<Home>& d) {
  d.about("Homes every axis by its own `homing` (MC_GroupHome).");
}

void describe(Description<SetPosition>& d) {
  d.about("Assigns new coordinates to the present position, without motion (MC_GroupSetPosition).");
  DescribeNumbers(d);
  DescribeSystem(d);
}

void describe(Description<SetOverride>& d) {
  using C = SetOverride;
  d.about("Scales the speed of present and later motions (MC_GroupSetOverride).");
  d.defaulted<&C::velocity_factor>(between(0, 1), "Factor of velocities; 0 holds the group on its path.");
  d.defaulted<&C::acceleration_factor>(kFactors, "Factor of accelerations and decelerations commanded from now on.");
  d.defaulted<&C::jerk_factor>(kFactors, "Factor of jerks commanded from now on.");
}

void describe(Description<SetKinTransform>& d) {
  d.about("Switches the kinematics on or off (MC_SetKinTransform).");
  d.defaulted<&SetKinTransform::enable>("False: the group moves its axes only, without a tool.");
}

void describe(Description<SetCartesianTransform>& d) {
  using C = SetCartesianTransform;
  d.about("Sets the pose of a product coordinate system in the machine coordinate system (MC_SetCartesianTransform).");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Number of the product coordinate system.");
  DescribePose(d);
}

void describe(Description<SetCoordinateTransform>& d) {
  using C = SetCoordinateTransform;
  d.about("Sets the pose of a product coordinate system in another coordinate system (MC_SetCoordinateTransform).");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Number of the product coordinate system.");
  DescribePose(d);
  d.defaulted<&C::reference>("Coordinate system of the pose: mcs, wcs or pcs.");
  d.defaulted<&C::reference_pcs>(between(1, kProductSystems), "Number of that product coordinate system, with pcs.");
}

void describe(Description<SetTool>& d) {
  d.about(
      "Sets the pose of the tool centre point on the flange after a change of the tool (GR-46). Requires that the "
      "group is at rest and no move waits. Before it, and again after a restart of the engine, `tool` of the group in "
      "the machine file applies.");
  DescribePose(d);
}

void describe(Description<Calibrate>& d) {
  using C = Calibrate;
  d.about(
      "Sets a product coordinate system from measured positions of the tool, and returns as value the largest distance "
      "of a position from the result (mm). Three positions: the origin, a point on X, a point towards Y; a fourth is "
      "the origin instead of the first. With the coordinates of all points in the system the result is the "
      "least-squares fit. Points that coincide or lie on one line define no system (3140). Moves in progress keep the "
      "previous system.");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Number of the product coordinate system.");
  d.required<&C::x1>(unit::mm, kPlaces, "X of the first position, in the MCS.");
  d.required<&C::y1>(unit::mm, kPlaces, "Y of the first position.");
  d.required<&C::z1>(unit::mm, kPlaces, "Z of the first position.");
  d.required<&C::x2>(unit::mm, kPlaces, "X of the second position.");
  d.required<&C::y2>(unit::mm, kPlaces, "Y of the second position.");
  d.required<&C::z2>(unit::mm, kPlaces, "Z of the second position.");
  d.required<&C::x3>(unit::mm, kPlaces, "X of the third position.");
  d.required<&C::y3>(unit::mm, kPlaces, "Y of the third position.");
  d.required<&C::z3>(unit::mm, kPlaces, "Z of the third position.");
  d.defaulted<&C::x4>(unit::mm, kPlaces, "X of the fourth position; unset: none.");
  d.defaulted<&C::y4>(unit::mm, kPlaces, "Y of the fourth position.");
  d.defaulted<&C::z4>(unit::mm, kPlaces, "Z of the fourth position.");
  d.defaulted<&C::seen_x1>(unit::mm, kPlaces, "X of the first point in the product coordinate system.");
  d.defaulted<&C::seen_y1>(unit::mm, kPlaces, "Y of the first point.");
  d.defaulted<&C::seen_z1>(unit::mm, kPlaces, "Z of the first point.");
  d.defaulted<&C::seen_x2>(unit::mm, kPlaces, "X of the second point.");
  d.defaulted<&C::seen_y2>(unit::mm, kPlaces, "Y of the second point.");
  d.defaulted<&C::seen_z2>(unit::mm, kPlaces, "Z of the second point.");
  d.defaulted<&C::seen_x3>(unit::mm, kPlaces, "X of the third point.");
  d.defaulted<&C::seen_y3>(unit::mm, kPlaces, "Y of the third point.");
  d.defaulted<&C::seen_z3>(unit::mm, kPlaces, "Z of the third point.");
  d.defaulted<&C::seen_x4>(unit::mm, kPlaces, "X of the fourth point.");
  d.defaulted<&C::seen_y4>(unit::mm, kPlaces, "Y of the fourth point.");
  d.defaulted<&C::seen_z4>(unit::mm, kPlaces, "Z of the fourth point.");
  d.defaulted<&C::largest_residual>(unit::mm, kLengths,
                                    "Largest permitted distance of a position from the result; above it the command is "
                                    "refused (3141). Unset: unlimited.");
}

void describe(Enumeration<ExecutionMode>& e) {
  e.about("Instant at which a command that is not itself a motion takes effect.");
  e.value(ExecutionMode::kImmediately, "immediately", "At once, whatever is in execution.");
  e.value(ExecutionMode::kDelayed, "delayed", "At the end of the move in execution.");
  e.value(ExecutionMode::kQueued, "queued", "At the end of all moves given before.");
}

void describe(Description<SetDynCoordTransform>& d) {
  using C = SetDynCoordTransform;
  d.about("Binds a product coordinate system to a moving carrier (MC_SetDynCoordTransform).");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Number of the product coordinate system.");
  d.required<&C::carrier>("Name of a belt, a table, another group (its tool) or a pose.");
  DescribePose(d);
  d.defaulted<&C::recorded_position>(
      unit::u, kAxisPositions,
      "Position of the belt's axis when the object was at that pose on the belt; unset: the present one.");
}

void describe(Description<TrackConveyorBelt>& d) {
  using C = TrackConveyorBelt;
  d.about("Synchronises the tool with an object on a belt, between two positions of the belt (MC_TrackConveyorBelt).");
  d.required<&C::belt>("Name of the belt.");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Product coordinate system that becomes the object's.");
  d.defaulted<&C::origin_x>(
      unit::mm, kPlaces,
      "X of ConveyorBeltOrigin in the MCS, along the belt; all unset: the belt's own origin, else 0.");
  d.defaulted<&C::origin_y>(unit::mm, kPlaces, "Y of ConveyorBeltOrigin.");
  d.defaulted<&C::origin_z>(unit::mm, kPlaces, "Z of ConveyorBeltOrigin.");
  d.defaulted<&C::origin_a>(unit::deg, kAngles, "Rotation of ConveyorBeltOrigin about X.");
  d.defaulted<&C::origin_b>(unit::deg, kAngles, "Rotation of ConveyorBeltOrigin about Y.");
  d.defaulted<&C::origin_c>(unit::deg, kAngles, "Rotation of ConveyorBeltOrigin about Z.");
  DescribePose(d);
  d.defaulted<&C::recorded_position>(
      unit::u, kAxisPositions,
      "RecordedPosition: position of the belt's axis when the object was at that pose; unset: the present one.");
  d.defaulted<&C::start_distance>(
      unit::mm, kPlaces,
      "StartDistance: travel of the belt from the recorded position, in addition to x, at which tracking begins.");
  d.defaulted<&C::end_distance>(unit::mm, kPlaces,
                                "EndDistance: travel from the recorded position at which tracking ends; unset: never.");
  d.defaulted<&C::sync_in_conveyor_distance>(
      unit::mm, kLengths, "Travel of the belt over which the tool gets into sync; 0: as fast as the limits allow.");
  d.defaulted<&C::sync_in_tcp_distance>(unit::mm, kLengths,
                                        "Displacement of the tool meanwhile; 0: that to the object, along the belt.");
  d.defaulted<&C::sync_out_conveyor_distance>(
      unit::mm, kLengths, "Travel of the belt over which the tool comes to rest; 0: as fast as the limits allow.");
  d.defaulted<&C::sync_out_tcp_distance>(unit::mm, kLengths,
                                         "Displacement of the tool meanwhile; 0: half of that travel.");
  d.defaulted<&C::execution_mode>("Instant at which the command takes effect.");
}

void describe(Description<TrackRotaryTable>& d) {
  using C = TrackRotaryTable;
  d.about("Synchronises the tool with an object on a rotary table, in either direction (MC_TrackRotaryTable).");
  d.required<&C::table>("Name of the belt of kind turning.");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Product coordinate system that becomes the object's.");
  DescribePose(d);
  d.defaulted<&C::recorded_position>(
      unit::u, kAxisPositions,
      "Position of the table's axis when the object was at that pose; unset: the present one.");
  d.defaulted<&C::start_angle>(
      unit::deg, kAngles,
      "Angle from the recorded position at which tracking begins, in the direction in which the table turns.");
  d.defaulted<&C::end_angle>(unit::deg, kAngles, "Angle at which tracking ends; unset: never.");
  d.defaulted<&C::sync_in_angle>(
      unit::deg, kTurns, "Angle of the table over which the tool gets into sync; 0: as fast as the limits allow.");
  d.defaulted<&C::sync_out_angle>(
      unit::deg, kTurns, "Angle of the table over which the tool comes to rest; 0: as fast as the limits allow.");
  d.defaulted<&C::execution_mode>("Instant at which the command takes effect.");
}

void describe(Description<PathChecked>& d) {
  using C = PathChecked;
  d.about("Answer to a path check request of the group. Given by the engine only.");
  d.required<&C::number>("Number of the request.");
  d.defaulted<&C::trouble>("Reason why the path is not free.");
  d.defaulted<&C::reason>("Reason why the axes cannot take a pose.");
  d.defaulted<&C::first>("Number of the moving part among the parts of the group, from 1.");
  d.defaulted<&C::second>("Number of the part it collides with; 0: none.");
  d.defaulted<&C::element>("Element of a path, from 1; 0: no path.");
  d.defaulted<&C::place>("Distance from the start of the move.");
  d.defaulted<&C::on_blend>("On the blend into the move or element.");
}

void describe(Description<PathPlanned>& d) {
  d.about("The plan ordered by the group is computed. Given by the engine only.");
  d.required<&PathPlanned::number>("Number of the order.");
}

}  // namespace takt::group
