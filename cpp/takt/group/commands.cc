#include "takt/group/commands.h"

#include <string_view>

#include "takt/group/texts.h"

namespace takt::group {

namespace {

template <typename T>
void DescribeNumbers(Description<T>& d) {
  d.template defaulted<&T::x>(unit::mm, kPlaces, "X of the tool. Not in ACS, as all of x to c.");
  d.template defaulted<&T::y>(unit::mm, kPlaces, "Y of the tool.");
  d.template defaulted<&T::z>(unit::mm, kPlaces, "Z of the tool.");
  d.template defaulted<&T::a>(unit::deg, kAngles, "Turned about X.");
  d.template defaulted<&T::b>(unit::deg, kAngles, "Turned about Y.");
  d.template defaulted<&T::c>(unit::deg, kAngles, "Turned about Z.");
  d.template defaulted<&T::a1>(unit::u, kAxisPositions, "Axis 1: any in ACS, else those beyond the kinematics.");
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
  d.template defaulted<&T::coordinate_system>("What the numbers are seen from (CoordSystem).");
  d.template defaulted<&T::pcs>(between(1, kProductSystems), "Which product coordinate system; with pcs.");
}

template <typename T>
void DescribeRamps(Description<T>& d) {
  d.template defaulted<&T::velocity>(unit::mm_s, kSpeeds, "Largest speed along the path; unset: the group's limit.");
  d.template defaulted<&T::acceleration>(unit::mm_s2, kAccelerations,
                                         "Largest acceleration along it; unset: the limit.");
  d.template defaulted<&T::deceleration>(unit::mm_s2, kAccelerations,
                                         "Largest deceleration along it; unset: the limit.");
  d.template defaulted<&T::jerk>(unit::mm_s3, kJerks, "Largest jerk along it; unset: the limit.");
}

template <typename T>
void DescribeTransition(Description<T>& d, std::string_view mode) {
  d.template defaulted<&T::transition_mode>(mode);
  d.template defaulted<&T::transition_parameter>(
      between(0, 1e9), "TransitionParameter: mm from the corner, mm of deviation, or mm/s at it, as the mode says.");
}

constexpr std::string_view kIntoThis = "How the move before goes over into this one, with a blending buffer mode.";

template <typename T>
void DescribeBuffering(Description<T>& d) {
  d.template defaulted<&T::buffer_mode>("How the move follows the one before it.");
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
  d.template defaulted<&M::circ_mode>("How the circle is given (CircMode).");
  d.template defaulted<&M::aux_x>(unit::mm, kPlaces, "AuxPoint: a point on the way, the centre, or a vector; X.");
  d.template defaulted<&M::aux_y>(unit::mm, kPlaces, "Y of it.");
  d.template defaulted<&M::aux_z>(unit::mm, kPlaces, "Z of it.");
  d.template defaulted<&M::path_choice>("Which of several arcs (PathChoice); none where a point on the way is given.");
  d.template defaulted<&M::normal_x>(kPlaces,
                                     "Normal of the plane, of any length, with a centre; all 0: that with Z above 0.");
  d.template defaulted<&M::normal_y>(kPlaces, "Y of it.");
  d.template defaulted<&M::normal_z>(kPlaces, "Z of it.");
  d.template defaulted<&M::turns>(at_most(path::kMostTurns), "Whole turns on top.");
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
      "To a pose: with the arm facing so. Keep, as that of the others: of all configurations and turns within the "
      "axes' "
      "ranges the one that the axes reach first.");
  d.template defaulted<&M::elbow>("To a pose: with the elbow so.");
  d.template defaulted<&M::wrist>("To a pose: with the wrist so.");
  d.template defaulted<&M::velocity_factor>(kFactors, "Of the axes' largest velocities.");
  d.template defaulted<&M::acceleration_factor>(kFactors, "Of their largest accelerations.");
  d.template defaulted<&M::jerk_factor>(kFactors, "Of their largest jerks.");
  DescribeBuffering(d);
}

template <typename T>
void DescribeBrake(Description<T>& d) {
  d.template defaulted<&T::deceleration>(unit::mm_s2, kAccelerations, "Largest deceleration; unset: that of the move.");
  d.template defaulted<&T::jerk>(unit::mm_s3, kJerks,
                                 "Largest jerk; unset: that of the move. Less makes the deceleration smaller, too.");
}

template <typename T>
void DescribePose(Description<T>& d) {
  d.template defaulted<&T::x>(unit::mm, kPlaces, "X of its origin.");
  d.template defaulted<&T::y>(unit::mm, kPlaces, "Y of it.");
  d.template defaulted<&T::z>(unit::mm, kPlaces, "Z of it.");
  d.template defaulted<&T::a>(unit::deg, kAngles, "Turned about X.");
  d.template defaulted<&T::b>(unit::deg, kAngles, "Turned about Y.");
  d.template defaulted<&T::c>(unit::deg, kAngles, "Turned about Z.");
}

}  // namespace

void describe(Enumeration<CoordinateSystem>& e) {
  e.about("What numbers are seen from.");
  e.value(CoordinateSystem::kAcs, "acs", "Axes: a1 to a8, each in its own unit.");
  e.value(CoordinateSystem::kMcs, "mcs", "The machine coordinate system: the kinematics' own.");
  e.value(CoordinateSystem::kWcs, "wcs", "The world, in which `base` of the group says where the machine stands.");
  e.value(CoordinateSystem::kPcs, "pcs", "One of 16 product coordinate systems, see set_cartesian_transform.");
}

void describe(Enumeration<TransitionMode>& e) {
  e.about("How one move goes over into the next.");
  e.value(TransitionMode::kNone, "none", "Through the corner itself.");
  e.value(TransitionMode::kStartVelocity, "start_velocity", "Rounded; the corner begins at the given speed.");
  e.value(TransitionMode::kConstantVelocity, "constant_velocity", "Rounded so that the given speed can be kept.");
  e.value(TransitionMode::kCornerDistance, "corner_distance", "Rounded from so many mm before the corner on.");
  e.value(TransitionMode::kMaxCornerDeviation, "max_corner_deviation", "Rounded, at most so many mm from the corner.");
}

void describe(Description<MoveLinearAbsolute>& d) {
  d.named("MoveLinearAbsolute");
  d.about("Moves straight to a place (MC_MoveLinearAbsolute). What is not given stays.");
  DescribeLinear(d);
}

void describe(Description<MoveLinearRelative>& d) {
  d.named("MoveLinearRelative");
  d.about("Moves straight on by a distance from where the move before ends (MC_MoveLinearRelative).");
  DescribeLinear(d);
}

void describe(Description<MoveCircularAbsolute>& d) {
  d.named("MoveCircularAbsolute");
  d.about("Moves along a circle or a helix to a place (MC_MoveCircularAbsolute). What is not given stays.");
  DescribeCircular(d);
}

void describe(Description<MoveCircularRelative>& d) {
  d.named("MoveCircularRelative");
  d.about(
      "Moves along a circle or a helix by a distance (MC_MoveCircularRelative). Points count from where it begins, "
      "too.");
  DescribeCircular(d);
}

void describe(Description<MoveDirectAbsolute>& d) {
  d.named("MoveDirectAbsolute");
  d.about(
      "Moves all axes to where the place is, each by itself, so that they arrive together (MC_MoveDirectAbsolute). "
      "What is not given stays.");
  DescribeDirect(d);
}

void describe(Description<MoveDirectRelative>& d) {
  d.named("MoveDirectRelative");
  d.about("Moves all axes by distances, so that they arrive together (MC_MoveDirectRelative).");
  DescribeDirect(d);
}

void describe(Description<MoveArch>& d) {
  d.about("Moves the tool along half an ellipse, upright in the world over where it begins and ends.");
  DescribeNumbers(d);
  d.defaulted<&MoveArch::height>(unit::mm, kLengths, "Of its crest above the higher of both points.");
  DescribeSystem(d);
  DescribeRamps(d);
  DescribeBuffering(d);
}

void describe(Description<MovePath>& d) {
  using M = MovePath;
  d.about("Moves along a path of the machine file (MC_PathSelect, MC_MovePath).");
  d.required<&M::path>("Its name.");
  DescribeSystem(d);
  DescribeRamps(d);
  d.defaulted<&M::buffer_mode>("How the move follows the one before it.");
  DescribeTransition(d, "How corners of the path are passed, and the one into it with a blending buffer mode.");
}

void describe(Description<MovePathSynchronized>& d) {
  using M = MovePathSynchronized;
  d.about(
      "Moves along a path of the machine file as a master axis moves (MC_MovePathSynchronized). Never faster than the "
      "limits: what is lost is made up.");
  d.required<&M::path>("Its name.");
  d.required<&M::master>("Name of the axis that gives the way.");
  d.defaulted<&M::ratio>(unit::mm_u_m, between(-1e9, 1e9), "Way along the path per way of the master, not 0.");
  DescribeSystem(d);
  DescribeRamps(d);
  DescribeTransition(d, "How corners of the path are passed.");
}

void describe(Description<SyncAxis>& d) {
  using C = SyncAxis;
  d.about(
      "Lets an axis that is no member follow the way along the path (MC_SyncAxisToGroup), until it gets a command of "
      "its own.");
  d.required<&C::axis>("Its name.");
  d.defaulted<&C::ratio_numerator>(unit::u, between(-1e9, 1e9), "So much of the axis ...");
  d.defaulted<&C::ratio_denominator>(unit::mm, between(-1e9, 1e9), "... per so much of the path, not 0.");
}

void describe(Enumeration<JogSystem>& e) {
  e.about("What the directions of a jog are seen from.");
  e.value(JogSystem::kAcs, "acs", "The axes themselves.");
  e.value(JogSystem::kMcs, "mcs", "The machine coordinate system.");
  e.value(JogSystem::kWcs, "wcs", "The world.");
  e.value(JogSystem::kPcs, "pcs", "A product, as it lies when the jog begins.");
  e.value(JogSystem::kTool, "tool", "The tool, as it is turned when the jog begins.");
}

void describe(Description<Jog>& d) {
  d.named("GroupJog");
  d.about(
      "Moves at these speeds as long as it is held, to the border of what can be reached, where it ends "
      "with an error. The other way is open from there. Given again in the same direction it changes the speed, in "
      "another one it comes to rest first; all 0, or a release, lets go: done when the group is at rest.");
  d.defaulted<&Jog::x>(unit::mm_s, kJogSpeeds, "Speed of the tool along X. Not in ACS, as all of x to c.");
  d.defaulted<&Jog::y>(unit::mm_s, kJogSpeeds, "Along Y.");
  d.defaulted<&Jog::z>(unit::mm_s, kJogSpeeds, "Along Z.");
  d.defaulted<&Jog::a>(unit::deg_s, kJogSpeeds, "Speed of its turn about X, through the tool centre point.");
  d.defaulted<&Jog::b>(unit::deg_s, kJogSpeeds, "About Y.");
  d.defaulted<&Jog::c>(unit::deg_s, kJogSpeeds, "About Z.");
  d.defaulted<&Jog::a1>(unit::u_s, kJogSpeeds, "Speed of axis 1: any in ACS, else those beyond the kinematics.");
  d.defaulted<&Jog::a2>(unit::u_s, kJogSpeeds, "Axis 2.");
  d.defaulted<&Jog::a3>(unit::u_s, kJogSpeeds, "Axis 3.");
  d.defaulted<&Jog::a4>(unit::u_s, kJogSpeeds, "Axis 4.");
  d.defaulted<&Jog::a5>(unit::u_s, kJogSpeeds, "Axis 5.");
  d.defaulted<&Jog::a6>(unit::u_s, kJogSpeeds, "Axis 6.");
  d.defaulted<&Jog::a7>(unit::u_s, kJogSpeeds, "Axis 7.");
  d.defaulted<&Jog::a8>(unit::u_s, kJogSpeeds, "Axis 8.");
  d.defaulted<&Jog::coordinate_system>("What the directions are seen from.");
  d.defaulted<&Jog::pcs>(between(1, kProductSystems), "Which product coordinate system; with pcs.");
  d.defaulted<&Jog::acceleration>(unit::mm_s2, kAccelerations, "Largest acceleration along the way; unset: the limit.");
  d.defaulted<&Jog::deceleration>(unit::mm_s2, kAccelerations, "Largest deceleration along it; unset: the limit.");
  d.defaulted<&Jog::jerk>(unit::mm_s3, kJerks, "Largest jerk along it; unset: the limit.");
}

void describe(Description<Stream>& d) {
  using C = Stream;
  d.named("GroupStream");
  d.about(
      "Follows external set points, one stream_point after another, at 20 Hz to once a cycle. Each axis follows a "
      "smooth "
      "curve through them, within its limits. Reached when all axes are on their curves. Takes over from moves and "
      "streams without a stop. Ends with error 3123 and a stop within limits when no set point has come for the "
      "timeout.");
  d.defaulted<&C::key>(
      "A number that the set points must carry: choose one of your own, so that no other client's are taken.");
  d.defaulted<&C::delay>(unit::s, between(0, 10),
                         "How long after it came the first set point is due, the others by their times: what jitter "
                         "and losses may take.");
  d.defaulted<&C::timeout>(unit::s, between(0.001, 60), "Longest time without a set point, from the first one on.");
  d.defaulted<&C::velocity_factor>(kFactors, "Of the axes' largest velocities, to get onto the set points.");
  d.defaulted<&C::acceleration_factor>(kFactors, "Of their largest accelerations, the same.");
  d.defaulted<&C::jerk_factor>(kFactors, "Of their largest jerks, the same.");
}

void describe(Description<StreamPoint>& d) {
  using C = StreamPoint;
  d.named("GroupStreamPoint");
  d.about(
      "A set point of the stream in control. What is not given stays as in the set point before. Refused "
      "without ending the stream: a key of another stream (3120), a time that has passed or has a set point (3121), "
      "further from the "
      "set point before than the axes can move in the time between them (3122), beyond a SW limit (8), a pose that "
      "cannot be reached (3021, 3022), a zone of another group (3130), a product coordinate system that moves (5).");
  DescribeNumbers(d);
  d.defaulted<&C::vx>(unit::mm_s, kJogSpeeds,
                      "How fast the tool is there along X. Those of the tool that are not given are 0; without any, "
                      "as the set points around it say.");
  d.defaulted<&C::vy>(unit::mm_s, kJogSpeeds, "Along Y.");
  d.defaulted<&C::vz>(unit::mm_s, kJogSpeeds, "Along Z.");
  d.defaulted<&C::wx>(unit::deg_s, kJogSpeeds, "How fast it turns about X, through the tool centre point.");
  d.defaulted<&C::wy>(unit::deg_s, kJogSpeeds, "About Y.");
  d.defaulted<&C::wz>(unit::deg_s, kJogSpeeds, "About Z.");
  d.defaulted<&C::v1>(unit::u_s, kJogSpeeds, "How fast axis 1 is there; unset: as the set points around it say.");
  d.defaulted<&C::v2>(unit::u_s, kJogSpeeds, "Axis 2.");
  d.defaulted<&C::v3>(unit::u_s, kJogSpeeds, "Axis 3.");
  d.defaulted<&C::v4>(unit::u_s, kJogSpeeds, "Axis 4.");
  d.defaulted<&C::v5>(unit::u_s, kJogSpeeds, "Axis 5.");
  d.defaulted<&C::v6>(unit::u_s, kJogSpeeds, "Axis 6.");
  d.defaulted<&C::v7>(unit::u_s, kJogSpeeds, "Axis 7.");
  d.defaulted<&C::v8>(unit::u_s, kJogSpeeds, "Axis 8.");
  DescribeSystem(d);
  d.defaulted<&C::time>(unit::s, between(-1e12, 1e12),
                        "When, by a clock of the sender that runs steadily; unset: on arrival.");
  d.defaulted<&C::key>("That of the stream.");
}

void describe(Description<Stop>& d) {
  d.about("Brakes to standstill on the path; nothing may take over until it is released (MC_GroupStop).");
  DescribeBrake(d);
  d.defaulted<&Stop::hold>("True: stay in GroupStopping until released (Execute kept true). False: until at rest.");
}

void describe(Description<Halt>& d) {
  d.about("Brakes to standstill on the path; another move may take over on the way (MC_GroupHalt).");
  DescribeBrake(d);
}

void describe(Description<Interrupt>& d) {
  d.about("Brakes to standstill on the path, where continue_path goes on (MC_GroupInterrupt).");
  DescribeBrake(d);
}

void describe(Description<Continue>& d) {
  d.about("Goes on with the path that was interrupted (MC_GroupContinue).");
}

void describe(Description<AddAxis>& d) {
  d.about("Takes an axis into a group that is not enabled (MC_AddAxisToGroup).");
  d.required<&AddAxis::axis>("Its name.");
  d.defaulted<&AddAxis::ident>(between(1, kMaxAxes), "Its place in the group (IdentInGroup): 1 is a1.");
}

void describe(Description<RemoveAxis>& d) {
  d.about("Takes an axis out of a group that is not enabled (MC_RemoveAxisFromGroup).");
  d.defaulted<&RemoveAxis::ident>(between(1, kMaxAxes), "Its place in the group (IdentInGroup).");
}

void describe(Description<UngroupAllAxes>& d) {
  d.about("Takes all axes out of the group, which is then disabled (MC_UngroupAllAxes).");
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
  d.about("Every axis looks for its reference as its `homing` says (MC_GroupHome).");
}

void describe(Description<SetPosition>& d) {
  d.about("Gives where the group stands other numbers, without a motion (MC_GroupSetPosition).");
  DescribeNumbers(d);
  DescribeSystem(d);
}

void describe(Description<SetOverride>& d) {
  using C = SetOverride;
  d.about("Scales the speed of the motion in progress and of those to come (MC_GroupSetOverride).");
  d.defaulted<&C::velocity_factor>(between(0, 1), "Of velocities; 0 holds the group on its path.");
  d.defaulted<&C::acceleration_factor>(kFactors, "Of accelerations and decelerations commanded from now on.");
  d.defaulted<&C::jerk_factor>(kFactors, "Of jerks commanded from now on.");
}

void describe(Description<SetKinTransform>& d) {
  d.about("Switches the kinematics on or off (MC_SetKinTransform).");
  d.defaulted<&SetKinTransform::enable>("False: the group knows its axes only, no tool.");
}

void describe(Description<SetCartesianTransform>& d) {
  using C = SetCartesianTransform;
  d.about("Says where a product coordinate system is in the machine coordinate system (MC_SetCartesianTransform).");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Which one.");
  DescribePose(d);
}

void describe(Description<SetCoordinateTransform>& d) {
  using C = SetCoordinateTransform;
  d.about("Says where a product coordinate system is in another coordinate system (MC_SetCoordinateTransform).");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Which one.");
  DescribePose(d);
  d.defaulted<&C::reference>("In which one it is: mcs, wcs or pcs.");
  d.defaulted<&C::reference_pcs>(between(1, kProductSystems), "Which product coordinate system that is; with pcs.");
}

void describe(Description<SetTool>& d) {
  d.about(
      "Says where the tool centre point is on the flange from now on: the tool was changed (GR-46). The group stands "
      "and nothing waits. `tool` of the group in the machine file counts until then, and again when the engine starts "
      "anew.");
  DescribePose(d);
}

void describe(Description<Calibrate>& d) {
  using C = Calibrate;
  d.about(
      "Sets a product coordinate system to where measured places of the tool have it, and returns as value how far the "
      "worst of them is from there (mm). Three: its origin, one on X, one towards Y; a fourth is its origin instead of "
      "the first. With the seen numbers of all places it is the nearest system by the sum of squares. Places that "
      "coincide or lie on one line define none (3140). What is under way in that system keeps it as it was.");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Which one.");
  d.required<&C::x1>(unit::mm, kPlaces, "First place, in the MCS; X.");
  d.required<&C::y1>(unit::mm, kPlaces, "Y of it.");
  d.required<&C::z1>(unit::mm, kPlaces, "Z of it.");
  d.required<&C::x2>(unit::mm, kPlaces, "Second place.");
  d.required<&C::y2>(unit::mm, kPlaces, "Y of it.");
  d.required<&C::z2>(unit::mm, kPlaces, "Z of it.");
  d.required<&C::x3>(unit::mm, kPlaces, "Third place.");
  d.required<&C::y3>(unit::mm, kPlaces, "Y of it.");
  d.required<&C::z3>(unit::mm, kPlaces, "Z of it.");
  d.defaulted<&C::x4>(unit::mm, kPlaces, "Fourth place; unset: none.");
  d.defaulted<&C::y4>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&C::z4>(unit::mm, kPlaces, "Z of it.");
  d.defaulted<&C::seen_x1>(unit::mm, kPlaces, "The first place as it is in the product coordinate system; X.");
  d.defaulted<&C::seen_y1>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&C::seen_z1>(unit::mm, kPlaces, "Z of it.");
  d.defaulted<&C::seen_x2>(unit::mm, kPlaces, "The second one.");
  d.defaulted<&C::seen_y2>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&C::seen_z2>(unit::mm, kPlaces, "Z of it.");
  d.defaulted<&C::seen_x3>(unit::mm, kPlaces, "The third one.");
  d.defaulted<&C::seen_y3>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&C::seen_z3>(unit::mm, kPlaces, "Z of it.");
  d.defaulted<&C::seen_x4>(unit::mm, kPlaces, "The fourth one.");
  d.defaulted<&C::seen_y4>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&C::seen_z4>(unit::mm, kPlaces, "Z of it.");
  d.defaulted<&C::largest_residual>(unit::mm, kLengths,
                                    "Refused where a place is further from where the system has it (3141).");
}

void describe(Enumeration<ExecutionMode>& e) {
  e.about("When a command that is no motion itself takes effect.");
  e.value(ExecutionMode::kImmediately, "immediately", "At once, whatever runs.");
  e.value(ExecutionMode::kDelayed, "delayed", "When the motion in progress is over.");
  e.value(ExecutionMode::kQueued, "queued", "When all motions given before are over.");
}

void describe(Description<SetDynCoordTransform>& d) {
  using C = SetDynCoordTransform;
  d.about("Lets a product coordinate system go along with something that moves (MC_SetDynCoordTransform).");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Which one.");
  d.required<&C::carrier>("Name of a belt, a table, another group (its tool) or a pose.");
  DescribePose(d);
  d.defaulted<&C::recorded_position>(unit::u, kAxisPositions,
                                     "Of the belt's axis when the object was at that place of the belt; unset: now.");
}

void describe(Description<TrackConveyorBelt>& d) {
  using C = TrackConveyorBelt;
  d.about(
      "Takes the tool along with an object on a belt, from one place of the belt to another (MC_TrackConveyorBelt).");
  d.required<&C::belt>("Name of the belt.");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Product coordinate system that becomes the object's.");
  d.defaulted<&C::origin_x>(unit::mm, kPlaces,
                            "ConveyorBeltOrigin in the MCS, X along the belt; unset: the belt's own.");
  d.defaulted<&C::origin_y>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&C::origin_z>(unit::mm, kPlaces, "Z of it.");
  d.defaulted<&C::origin_a>(unit::deg, kAngles, "Turned about X.");
  d.defaulted<&C::origin_b>(unit::deg, kAngles, "Turned about Y.");
  d.defaulted<&C::origin_c>(unit::deg, kAngles, "Turned about Z.");
  DescribePose(d);
  d.defaulted<&C::recorded_position>(
      unit::u, kAxisPositions, "RecordedPosition: of the belt's axis when the object was at that pose; unset: now.");
  d.defaulted<&C::start_distance>(unit::mm, kPlaces, "StartDistance: travel, and x more, after which tracking begins.");
  d.defaulted<&C::end_distance>(unit::mm, kPlaces, "EndDistance: travel after which it ends; unset: never.");
  d.defaulted<&C::sync_in_conveyor_distance>(
      unit::mm, kLengths, "Travel in which the tool gets into step; 0: as fast as the limits allow.");
  d.defaulted<&C::sync_in_tcp_distance>(unit::mm, kLengths,
                                        "How far the tool goes meanwhile; 0: to the object, along the belt.");
  d.defaulted<&C::sync_out_conveyor_distance>(unit::mm, kLengths,
                                              "Travel in which the tool comes to rest; 0: likewise.");
  d.defaulted<&C::sync_out_tcp_distance>(unit::mm, kLengths, "How far the tool goes meanwhile; 0: half of that.");
  d.defaulted<&C::execution_mode>("When it takes effect.");
}

void describe(Description<TrackRotaryTable>& d) {
  using C = TrackRotaryTable;
  d.about("Takes the tool along with an object on a table that turns, either way round (MC_TrackRotaryTable).");
  d.required<&C::table>("Name of the belt of kind turning.");
  d.defaulted<&C::pcs>(between(1, kProductSystems), "Product coordinate system that becomes the object's.");
  DescribePose(d);
  d.defaulted<&C::recorded_position>(unit::u, kAxisPositions,
                                     "Of the table's axis when the object was at that pose; unset: now.");
  d.defaulted<&C::start_angle>(unit::deg, kAngles, "Turn after which tracking begins, in the sense of the table.");
  d.defaulted<&C::end_angle>(unit::deg, kAngles, "Turn after which it ends; unset: never.");
  d.defaulted<&C::sync_in_angle>(unit::deg, kTurns,
                                 "Turn in which the tool gets into step; 0: as fast as the limits allow.");
  d.defaulted<&C::sync_out_angle>(unit::deg, kTurns, "Turn in which the tool comes to rest; 0: likewise.");
  d.defaulted<&C::execution_mode>("When it takes effect.");
}

void describe(Description<PathChecked>& d) {
  using C = PathChecked;
  d.about("Whether the path that the group asks about is free. Given by the engine alone.");
  d.required<&C::number>("Of the question.");
  d.defaulted<&C::trouble>("What is wrong with it.");
  d.defaulted<&C::reason>("Why there is no position of the links.");
  d.defaulted<&C::first>("What moves: its number among the parts of the group, from 1.");
  d.defaulted<&C::second>("What it meets; 0: nothing.");
  d.defaulted<&C::element>("Element of a path, from 1; 0: no path.");
  d.defaulted<&C::place>("Where: from the beginning of the move.");
  d.defaulted<&C::on_blend>("On the blend into it.");
}

void describe(Description<PathPlanned>& d) {
  d.about("The plan that the group has asked for is there. Given by the engine alone.");
  d.required<&PathPlanned::number>("Of the order.");
}

}  // namespace takt::group
