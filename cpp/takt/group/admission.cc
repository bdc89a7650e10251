// Commands on arrival: queues moves, changes settings, or refuses.
#include "takt/core/describe.h"
#include "takt/core/in_range.h"
#include "takt/group/ask.h"
#include "takt/group/boarding.h"
#include "takt/group/calibrate.h"
#include "takt/group/clutch.h"
#include "takt/group/group.h"
#include "takt/group/jog.h"
#include "takt/group/make_request.h"
#include "takt/group/members.h"
#include "takt/group/plan.h"
#include "takt/group/queue.h"
#include "takt/group/run.h"
#include "takt/group/stream.h"
#include "takt/group/sync.h"
#include "takt/group/systems.h"
#include "takt/group/track.h"

namespace takt::group {

namespace {

struct Applier {
  const Context& c;
  Ticket ticket;
  double lease_s;
  State& s;

  void Refuse(ErrorId error) const { Report(c, ticket, FeedbackState::kError, error); }
  void Finish(ErrorId error) const {
    if (error != ErrorId::kNone) return Refuse(error);
    Report(c, ticket, FeedbackState::kActive);
    Report(c, ticket, FeedbackState::kDone);
  }
  bool Is(GroupState state) const { return s.state == state; }
  bool stands() const { return Is(GroupState::kDisabled) || Is(GroupState::kStandby); }
  // Members and kinematics may be changed: no command that waits for an object to track relies on them.
  bool MayBeChanged() const { return stands() && s.track.ticket == 0; }

  // The feedback of the error names the member.
  ErrorId Blamed(ErrorId error, std::size_t place) const {
    c.ahead.blame = {error, s.members[place]};
    return error;
  }

  // Power off takes precedence over all that moves or stops a group: it is completed.
  bool SwitchingOff() const { return s.task == Task::kPower && !s.power_on; }

  ErrorId MayMove() const {
    if (Is(GroupState::kDisabled)) return ErrorId::kGroupDisabled;
    if (SwitchingOff()) return ErrorId::kAxisStopping;
    if (Is(GroupState::kErrorStop)) return ErrorId::kErrorStop;
    if (Is(GroupState::kStopping) || s.holds.Holder() != nullptr) return ErrorId::kAxisStopping;
    if (Is(GroupState::kHoming)) return ErrorId::kState;
    if (CountOf(s) == 0) return ErrorId::kGroupEmpty;
    for (std::size_t k = 0; k < kMaxAxes; ++k) {
      if (s.members[k] == 0) continue;
      const axis::State& member = MemberOf(c, s, k);
      if (!member.loop_closed) return Blamed(ErrorId::kPowerOff, k);
      const bool needs_reference = ContextOf(c, s, k).params.requires_reference && !member.homing.homed;
      if (needs_reference) return Blamed(ErrorId::kNoReference, k);
    }
    return ErrorId::kNone;
  }

  void AbortTask() const { EndTask(c, FeedbackState::kAborted, ErrorId::kNone, s); }

  // Aborts everything that is planned or waits.
  void AbortAll(const Brake& brake = {}, bool lets_go = true) const {
    AbortTask();
    EndStream(c, FeedbackState::kAborted, ErrorId::kNone, s);
    AbortMoves(c, ErrorId::kNone, s);
    GiveUpPath(c, brake, lets_go, s);
  }

  // Returns true if a product coordinate system is bound to a carrier of unknown pose.
  bool IsLost(std::uint32_t pcs) const {
    const std::uint32_t carrier = s.cargoes[pcs].carrier;
    return carrier != 0 && c.carriers.At(carrier).kind == kinematics::CarrierKind::kNone;
  }

  void Move(const MadeRequest& made) const {
    if (made.error != ErrorId::kNone) return Refuse(made.error);
    if (const ErrorId error = MayMove(); error != ErrorId::kNone) return Refuse(error);
    if (made.move.system == CoordinateSystem::kPcs && IsLost(made.move.pcs)) return Refuse(ErrorId::kCarrierUnknown);
    const bool waits = made.move.buffer_mode != BufferMode::kAborting;
    if (waits && (s.task == Task::kHalt || Jogs(s) || Streams(s))) return Refuse(ErrorId::kState);
    const std::uint32_t carrier = made.move.system == CoordinateSystem::kPcs ? s.cargoes[made.move.pcs].carrier : 0;
    // While boarding a carrier, the tool turns back for a move that leads elsewhere.
    if (!waits) AbortAll({}, ShouldAbortBoarding(c, s, carrier));
    if (!c.ahead.known && !s.begun) c.ahead.window.SetLimits(LimitsOf(c, s));
    Request move = made.move;
    move.ticket = ticket;
    move.frame = kinematics::ToPose(SystemFrame(c, s, move.system, move.pcs));
    if (move.system == CoordinateSystem::kPcs) move.cargo = s.cargoes[move.pcs];
    if (!Push(move, s)) return Refuse(ErrorId::kBufferFull);
    Report(c, ticket, FeedbackState::kBusy);
    if (Is(GroupState::kStandby)) Enter(GroupState::kMoving, s);
  }

  void Jog(const MadeRequest& made) const {
    if (IsReleased(made.move)) {
      if (!Jogs(s)) return Finish(ErrorId::kNone);
      Report(c, MoveAt(s, s.done).ticket, FeedbackState::kAborted);
      return EndJog(c, ticket, s);
    }
    if (made.error != ErrorId::kNone) return Refuse(made.error);
    if (const ErrorId error = MayMove(); error != ErrorId::kNone) return Refuse(error);
    if (made.move.jog_system == JogSystem::kPcs && IsLost(made.move.pcs)) return Refuse(ErrorId::kCarrierUnknown);
    if (!ChangeJog(c, ticket, made.move, s)) {
      EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
      AbortAll();
      if (!c.ahead.known && !s.begun) c.ahead.window.SetLimits(LimitsOf(c, s));
      BeginJog(c, ticket, made.move, s);
      if (Is(GroupState::kStandby)) Enter(GroupState::kMoving, s);
    }
    s.lease_s = lease_s;
    s.lease_end_cycle = CycleIn(c.cycle, lease_s);
  }

  void operator()(const Stream& m) const {
    if (const ErrorId error = MayMove(); error != ErrorId::kNone) return Refuse(error);
    if (const ErrorId error = BeginStream(c, ticket, m, s); error != ErrorId::kNone) Refuse(error);
  }
  void operator()(const StreamPoint& m) const {
    if (const ErrorId error = TakePoint(c, m, s); error != ErrorId::kNone) return Refuse(error);
    Report(c, ticket, FeedbackState::kDone);
  }

  void operator()(const Stop& m) const {
    if (Is(GroupState::kDisabled)) return Refuse(ErrorId::kGroupDisabled);
    if (Is(GroupState::kErrorStop)) return Refuse(ErrorId::kErrorStop);
    if (SwitchingOff()) return Refuse(ErrorId::kAxisStopping);
    EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
    AbortAll({m.deceleration.value_or(0), m.jerk.value_or(0)});
    if (Is(GroupState::kHoming)) CommandAll(c, s, axis::Stop{});
    // A drive may home before it is ready: its member is not on the path and stops individually.
    for (std::size_t k = 0; k < kMaxAxes; ++k) {
      const bool gets_ready = s.members[k] != 0 && MemberOf(c, s, k).enable && !MemberOf(c, s, k).loop_closed;
      if (gets_ready) Tell(c, s, k, axis::Stop{});
    }
    s.ends = true;
    s.task = Task::kStop;
    const bool room = !m.hold || s.holds.Add({ticket, lease_s, CycleIn(c.cycle, lease_s), true, true});
    s.ticket = room ? ticket : 0;
    s.stop_reported = false;
    Report(c, ticket, FeedbackState::kActive);
    if (!room) Refuse(ErrorId::kBufferFull);  // it brakes nevertheless
    Enter(GroupState::kStopping, s);
  }
  void operator()(const Halt& m) const {
    if (const ErrorId error = MayMove(); error != ErrorId::kNone) return Refuse(error);
    EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
    AbortAll({m.deceleration.value_or(0), m.jerk.value_or(0)});
    s.ends = true;
    s.task = Task::kHalt;
    s.ticket = ticket;
    Report(c, ticket, FeedbackState::kActive);
    if (Is(GroupState::kStandby)) Enter(GroupState::kMoving, s);
  }
  void operator()(const Interrupt& m) const {
    if (!Is(GroupState::kMoving) || s.ends || Streams(s) || IsOnFreeCarrier(c, s)) return Refuse(ErrorId::kState);
    AbortTask();
    s.interrupted = s.lets_go = true;
    for (Clutch& clutch : s.clutches) clutch.law_length = 0;
    s.brake = {m.deceleration.value_or(0), m.jerk.value_or(0)};
    if (!s.begun) return Finish(ErrorId::kNone);  // it does not move yet
    s.task = Task::kInterrupt;
    s.ticket = ticket;
    Report(c, ticket, FeedbackState::kActive);
  }
  void operator()(const Continue&) const {
    if (!Is(GroupState::kMoving) || !s.interrupted) return Refuse(ErrorId::kState);
    AbortTask();
    s.interrupted = s.lets_go = false;
    c.ahead.delayed = true;
    s.brake = {};
    Finish(ErrorId::kNone);
  }

  void operator()(const AddAxis& m) const {
    if (!MayBeChanged()) return Refuse(ErrorId::kState);
    Finish(Add(c, m, s));
  }
  void operator()(const RemoveAxis& m) const {
    if (!MayBeChanged()) return Refuse(ErrorId::kState);
    const ErrorId error = Remove(c, m, s);
    if (error == ErrorId::kNone && CountOf(s) == 0 && Is(GroupState::kStandby)) Enter(GroupState::kDisabled, s);
    Finish(error);
  }
  void operator()(const UngroupAllAxes&) const {
    if (Is(GroupState::kErrorStop)) return Refuse(ErrorId::kErrorStop);
    if (SwitchingOff() && s.begun) return Refuse(ErrorId::kAxisStopping);
    if (CountOf(s) > 0) LeaveAll();
    const ErrorId error = Ungroup(c, s);
    if (!Is(GroupState::kDisabled)) Enter(GroupState::kDisabled, s);
    Finish(error);
  }
  void operator()(const Enable&) const {
    if (CountOf(s) == 0) return Refuse(ErrorId::kGroupEmpty);
    if (!stands()) return Refuse(ErrorId::kState);
    // Individual motions of the members must be over.
    const bool still = AllMembers(c, s, [](const axis::State& member) {
      return member.plc == axis::PlcState::kDisabled || member.plc == axis::PlcState::kStandstill;
    });
    if (!still) return Refuse(ErrorId::kState);
    if (Is(GroupState::kDisabled)) Enter(GroupState::kStandby, s);
    Finish(ErrorId::kNone);
  }
  // Dissolves the group: the members come to rest individually.
  void LeaveAll() const {
    EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
    AbortAll();
    if (s.state == GroupState::kHoming) CommandAll(c, s, axis::Stop{});
    ReleaseMembers(c, s);
    ReleaseSynced(c, FeedbackState::kDone, s);
    ForgetPlan(c, s);
    s.begun = s.ends = s.lets_go = false;
    s.active = 0;
    s.clutches = {};
    s.ridden = {};
    s.rise = {};
    s.pace = {};
    s.master = {};
  }
  void operator()(const Disable&) const {
    if (Is(GroupState::kErrorStop)) return Refuse(ErrorId::kErrorStop);
    if (SwitchingOff() && s.begun) return Refuse(ErrorId::kAxisStopping);
    LeaveAll();
    if (!Is(GroupState::kDisabled)) Enter(GroupState::kDisabled, s);
    Finish(ErrorId::kNone);
  }
  void operator()(const Reset&) const {
    const bool well = AllMembers(c, s, [](const axis::State& member) { return member.error == ErrorId::kNone; });
    if (!Is(GroupState::kErrorStop) && well) return Finish(ErrorId::kNone);
    if (s.resetting) Report(c, s.reset_ticket, FeedbackState::kAborted);
    s.resetting = true;
    s.reset_asked = false;
    s.reset_ticket = ticket;
    Report(c, ticket, FeedbackState::kActive);
  }
  void operator()(const Power& m) const {
    if (m.enable && Is(GroupState::kErrorStop)) return Refuse(ErrorId::kErrorStop);
    if (m.enable && (Is(GroupState::kStopping) || SwitchingOff())) return Refuse(ErrorId::kAxisStopping);
    if (m.enable && Is(GroupState::kHoming)) return Refuse(ErrorId::kState);
    if (CountOf(s) == 0) return Refuse(ErrorId::kGroupEmpty);
    if (m.enable && s.guides) return Finish(ErrorId::kNone);
    if (!m.enable && (s.begun || s.queue.count > 0 || Streams(s))) {  // brakes along the path first
      EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
      AbortAll();
      s.task = Task::kPower;
      s.power_on = false;
      s.ticket = ticket;
      return Report(c, ticket, FeedbackState::kActive);
    }
    AbortTask();
    if (!m.enable) EndTracking(c, FeedbackState::kAborted, ErrorId::kNone, s);
    if (!m.enable && Is(GroupState::kStopping)) Enter(GroupState::kStandby, s);
    const ErrorId error = m.enable ? CommandAll(c, s, axis::Power{}) : SwitchOffAll(c, s);
    if (error != ErrorId::kNone) return Refuse(error);
    s.task = Task::kPower;
    s.power_on = m.enable;
    s.ticket = ticket;
    Report(c, ticket, FeedbackState::kActive);
  }
  void operator()(const Home&) const {
    if (!Is(GroupState::kStandby)) return Refuse(Is(GroupState::kDisabled) ? ErrorId::kGroupDisabled : ErrorId::kState);
    if (s.holds.Holder() != nullptr) return Refuse(ErrorId::kAxisStopping);
    const ErrorId error = CommandAll(c, s, axis::Home{});
    if (error != ErrorId::kNone) {
      // Members that have begun stop; until then the group is homing.
      for (std::size_t k = 0; k < kMaxAxes; ++k) {
        if (s.members[k] == 0 || MemberOf(c, s, k).plc != axis::PlcState::kHoming) continue;
        Tell(c, s, k, axis::Stop{});
        Enter(GroupState::kHoming, s);
      }
      return Refuse(error);
    }
    AbortTask();
    s.task = Task::kHome;
    s.ticket = ticket;
    Report(c, ticket, FeedbackState::kActive);
    Enter(GroupState::kHoming, s);
  }
  void operator()(const SetPosition& m) const {
    if (!stands()) return Refuse(ErrorId::kState);
    const std::array<std::optional<double>, kToolNumbers> tool = {m.x, m.y, m.z, m.a, m.b, m.c};
    const std::array<std::optional<double>, kMaxAxes> axes = {m.a1, m.a2, m.a3, m.a4, m.a5, m.a6, m.a7, m.a8};
    const std::size_t moved = m.coordinate_system == CoordinateSystem::kAcs ? 0 : InKinematics(c, s);
    const bool of_tool = std::ranges::any_of(tool, [](const auto& number) { return number.has_value(); });
    if (m.coordinate_system == CoordinateSystem::kAcs ? of_tool : moved == 0) return Refuse(ErrorId::kParameter);
    End end = Present(c, s);
    if (of_tool) {
      const Frame system = SystemFrame(c, s, m.coordinate_system, m.pcs - 1);
      kinematics::Pose pose = kinematics::ToPose(system.Inverse() * end.tool);
      double* const numbers[] = {&pose.x, &pose.y, &pose.z, &pose.a, &pose.b, &pose.c};
      for (std::size_t i = 0; i < kToolNumbers; ++i) *numbers[i] = tool[i].value_or(*numbers[i]);
      s.reason = JointsAt(c, system * kinematics::ToFrame(pose), end.joints, end.joints);
      if (s.reason == kinematics::Reason::kNone && !WithinRanges(c, s, end.joints, moved)) {
        s.reason = kinematics::Reason::kAxisLimit;
      }
      if (s.reason != kinematics::Reason::kNone) return Refuse(ErrorId::kUnreachable);
    }
    for (std::size_t k = 0; k < kMaxAxes; ++k) {
      if (s.members[k] == 0 && axes[k]) return Refuse(ErrorId::kNotGroupMember);
      if (k < moved && axes[k]) return Refuse(ErrorId::kParameter);
    }
    const auto with_each = [&](auto set) {
      for (std::size_t k = 0; k < kMaxAxes; ++k) {
        if (s.members[k] == 0 || !(k < moved ? of_tool : axes[k].has_value())) continue;
        const axis::SetPosition position{.position = k < moved ? end.joints[k] : *axes[k]};
        if (const ErrorId error = set(k, position); error != ErrorId::kNone) return error;
      }
      return ErrorId::kNone;
    };
    const auto try_it = [&](std::size_t k, const axis::SetPosition& position) { return Try(c, s, k, position); };
    const auto do_it = [&](std::size_t k, const axis::SetPosition& position) { return Tell(c, s, k, position); };
    if (const ErrorId error = with_each(try_it); error != ErrorId::kNone) return Refuse(error);
    Finish(with_each(do_it));
  }
  void operator()(const SetOverride& m) const {
    s.velocity_factor = m.velocity_factor;
    s.acceleration_factor = m.acceleration_factor;
    s.jerk_factor = m.jerk_factor;
    Finish(ErrorId::kNone);
  }
  void operator()(const SetKinTransform& m) const {
    if (!MayBeChanged()) return Refuse(ErrorId::kState);
    if (m.enable && !c.kinematics) return Refuse(ErrorId::kParameter);
    s.kinematics_on = m.enable;
    Finish(ErrorId::kNone);
  }
  void operator()(const SetDynCoordTransform& m) const {
    CarriedTarget cargo;
    cargo.carrier = c.carriers.Find(m.carrier.view());
    if (cargo.carrier == 0) return Refuse(ErrorId::kUnknownTarget);
    cargo.lies = {m.x, m.y, m.z, m.a, m.b, m.c};
    cargo.from = m.recorded_position ? c.carriers.TravelAt(cargo.carrier, *m.recorded_position)
                                     : c.carriers.At(cargo.carrier).travel.position;
    s.cargoes[m.pcs - 1] = cargo;
    Finish(ErrorId::kNone);
  }
  template <typename T>
  void Track(const T& m) const {
    ErrorId error = Streams(s) ? ErrorId::kState : MayMove();
    if (error == ErrorId::kNone) error = BeginTracking(c, ticket, m, s);
    if (error != ErrorId::kNone) Refuse(error);
  }
  void operator()(const TrackConveyorBelt& m) const { Track(m); }
  void operator()(const TrackRotaryTable& m) const { Track(m); }
  void operator()(const SetCartesianTransform& m) const {
    s.cargoes[m.pcs - 1] = {};
    s.product_systems[m.pcs - 1] = {m.x, m.y, m.z, m.a, m.b, m.c};
    Finish(ErrorId::kNone);
  }
  void operator()(const SetTool& m) const {
    if (!c.kinematics) return Refuse(ErrorId::kParameter);
    if (!stands() || s.queue.count > 0 || s.track.ticket != 0 || s.guides) return Refuse(ErrorId::kState);
    s.tool_changed = true;
    s.tool = {m.x, m.y, m.z, m.a, m.b, m.c};
    MountTool(kinematics::ToFrame(s.tool), c.mounting);
    ForgetPlan(c, s);  // it ends at the pose of the previous tool
    Finish(ErrorId::kNone);
  }
  void operator()(const Calibrate& m) const {
    const std::optional<Calibrated> made = FrameOf(m);
    if (!made) return Refuse(ErrorId::kNoFrame);
    if (m.largest_residual && made->largest > *m.largest_residual) {
      return Report(c, ticket, FeedbackState::kError, ErrorId::kResidual, made->largest);
    }
    s.cargoes[m.pcs - 1] = {};
    s.product_systems[m.pcs - 1] = made->pose;
    Report(c, ticket, FeedbackState::kActive);
    Report(c, ticket, FeedbackState::kDone, ErrorId::kNone, made->largest);
  }
  void operator()(const SetCoordinateTransform& m) const {
    if (m.reference == CoordinateSystem::kAcs) return Refuse(ErrorId::kParameter);
    const Frame reference = SystemFrame(c, s, m.reference, m.reference_pcs - 1);
    s.cargoes[m.pcs - 1] = {};
    s.product_systems[m.pcs - 1] = kinematics::ToPose(reference * kinematics::ToFrame({m.x, m.y, m.z, m.a, m.b, m.c}));
    Finish(ErrorId::kNone);
  }
  void operator()(const SyncAxis& m) const {
    if (Is(GroupState::kDisabled)) return Refuse(ErrorId::kGroupDisabled);
    if (Is(GroupState::kErrorStop)) return Refuse(ErrorId::kErrorStop);
    if (const ErrorId error = Sync(c, ticket, m, s); error != ErrorId::kNone) return Refuse(error);
    Report(c, ticket, FeedbackState::kActive);
  }
  void operator()(const PathPlanned& m) const {
    c.ahead.timing.TakePlan(m.number);
    Finish(ErrorId::kNone);
  }
  void operator()(const PathChecked& m) const { Finish(Take(m, s) ? ErrorId::kNone : ErrorId::kState); }
  template <typename T>
  void operator()(const T&) const {}  // moves: see Apply
};

}  // namespace

void Apply(const Context& c, Ticket ticket, double lease_s, const Command& command, State& s) noexcept {
  const bool in_range = std::visit([](const auto& body) { return InRange(body); }, command);
  c.ahead.blame = {};
  const Applier applier{c, ticket, lease_s, s};
  if (!in_range) return applier.Refuse(ErrorId::kParameter);
  if (const auto made = MakeRequest(c, s, command)) {
    return IsJog(made->move) ? applier.Jog(*made) : applier.Move(*made);
  }
  std::visit(applier, command);
}

}  // namespace takt::group
