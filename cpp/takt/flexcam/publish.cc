// The outputs of a module.
#include "takt/axis/axis.h"
#include "takt/flexcam/run.h"

#include <cmath>

namespace takt::flexcam {

namespace {

// Returns Table::number of the cam with this index, counted from 1; 0: none.
std::uint32_t NumberOf(const Context& c, std::uint32_t from_one) {
  return from_one == 0 ? 0 : static_cast<std::uint32_t>(c.slave.machine.cams[from_one - 1].number());
}

void PublishClutch(const Context& c, const State& s, Outputs& out) {
  const ClutchState& clutch = s.clutch;
  out.clutch = clutch.phase;
  out.clutch_waits = clutch.waits;
  out.clutch_position = out.clutch_distance = out.clutch_master_velocity = 0;
  const bool planned = clutch.phase == ClutchPhase::kWaitingIn && clutch.planned_sense != 0;
  const ClutchCurve* curve = FollowedCurve(clutch);
  if (curve != nullptr) out.clutch_master_velocity = curve->fastest;
  if (!planned && curve == nullptr) return;
  const double end = planned ? clutch.place : EndOf(*curve);
  out.clutch_position = ReportedOf(c.slave, c.master, end - ZeroOf(c.slave, c.master));
  out.clutch_distance = std::abs(end - s.master.now.position);
}

}  // namespace

void Publish(const Context& c, const axis::State& slave, const State& s, Outputs& out) noexcept {
  const axis::AxisParams& p = c.slave.params;
  const double ky = s.inputs.scaling_slave;
  const Cycle& cycle = c.slave.cycle;
  const Conversion& to_x = s.way.to_x;
  const Conversion& to_slave = s.way.to_slave;
  out.set_offset_master = OffsetInForce(to_x, cycle);
  out.set_offset_slave = OffsetInForce(to_slave, cycle);
  out.set_scaling_master = FactorInForce(to_x, cycle, s.master.now);
  out.set_scaling_slave = FactorInForce(to_slave, cycle, s.y);
  out.set_x_position = s.at.x;
  out.set_x_velocity = s.x.velocity;
  out.set_x_acceleration = s.x.acceleration;
  out.set_y_position = s.at.y_in_cam;
  out.set_y_velocity = s.y.velocity;
  out.set_y_acceleration = s.y.acceleration;
  out.actual_slave_position = axis::Reported(p, slave.actual.position);
  out.actual_slave_velocity = slave.actual.velocity;
  out.bounds_valid = s.bounds.valid;
  if (s.bounds.valid) {
    out.slave_max_position = ky * s.bounds.max_position + s.inputs.offset_slave;
    out.slave_min_position = ky * s.bounds.min_position + s.inputs.offset_slave;
    out.slave_max_velocity = ky * s.bounds.max_velocity;
    out.slave_max_acceleration = ky * s.bounds.max_acceleration;
  }
  out.ip01_set_scaling_master = s.inputs.scaling_master;
  out.ip02_scaling_mode_master = s.settings.scaling_mode_master;
  out.ip03_set_offset_master = s.inputs.offset_master;
  out.ip04_set_offset_slave = s.inputs.offset_slave;
  out.ip05_offset_mode_slave = s.settings.offset_mode_slave;
  out.ip06_set_scaling_slave = s.inputs.scaling_slave;
  out.ip07_scaling_mode_slave = s.settings.scaling_mode_slave;
  out.ip08_cam_table1 = NumberOf(c, s.slots[0]);
  out.ip09_cam_table2 = NumberOf(c, s.slots[1]);
  out.ip10_cam_table3 = NumberOf(c, s.slots[2]);
  out.ip11_cam_table4 = NumberOf(c, s.slots[3]);
  const double master = s.master.now.position - ZeroOf(c.slave, c.master);
  out.mp01_set_master_position = ReportedOf(c.slave, c.master, master);
  out.mp02_set_slave_position = axis::Reported(p, slave.setpoint.position);
  out.mp03_master_to_x_position = s.x.position;
  out.mp04_cam_profiler_position_out = s.at.y_in_cam;
  out.mp05_set_y_position = s.at.y;
  out.mp06_y_to_slave_position = axis::Reported(p, s.wanted.position - slave.origin);
  out.op01_set_x_position_out = s.at.x;
  out.op02_set_y_position_out = s.at.y_in_cam;
  PublishClutch(c, s, out);
  out.error = s.error;
  out.warning = s.warning;
  out.state = s.state;
  const std::uint32_t running = s.way.profiler.slot;
  const std::uint32_t next = s.pending_count > 0 ? s.pending[0].change.cam_table : s.inputs.cam_table;
  out.cam_table = running;
  out.cam_number = NumberOf(c, s.way.profiler.cam + 1);
  out.next_cam_table = next == running || s.state != ModuleState::kSync ? 0 : next;
  out.pending_changes = s.pending_count;
  out.cam_ends = s.cam_ends;
  out.internal_control_active = s.inputs.internal_control;
  out.axis_enabled = slave.loop_closed;
  out.done = s.done;
  out.busy = s.action != Action::kNone;
  out.is_homed = slave.homing.homed;
  out.hw_limit_switch_positive = slave.limit_positive || s.inputs.hw_limit_positive;
  out.hw_limit_switch_negative = slave.limit_negative || s.inputs.hw_limit_negative;
  out.sw_limit_enabled = p.limits.lower.has_value() || p.limits.upper.has_value();
  out.sw_limit_switch_active =
      s.error == ErrorId::kModuleSoftLimitPositive || s.error == ErrorId::kModuleSoftLimitNegative;
  const bool sync = s.state == ModuleState::kSync;
  const ClutchPhase phase = s.clutch.phase;
  const bool on_cam = phase == ClutchPhase::kClosed || phase == ClutchPhase::kWaitingOut;
  out.cam_synchronised = sync && on_cam && slave.guidance.chase.in_step;
  out.acc_dec_sync =
      sync && (phase == ClutchPhase::kClosing || phase == ClutchPhase::kOpening || phase == ClutchPhase::kReleased);
  out.end_of_profile = sync && s.end_of_profile;
  out.sequencer_active = sync && IsActive(SequencerOf(c, s), s.sequencer);
  out.master_lost = !s.master.known;
  out.offset_master_done = IsSettled(s, Adjustment::kOffsetMaster);
  out.offset_slave_done = IsSettled(s, Adjustment::kOffsetSlave);
  out.scaling_master_done = IsSettled(s, Adjustment::kScalingMaster);
  out.scaling_slave_done = IsSettled(s, Adjustment::kScalingSlave);
  out.offset_master_busy = !out.offset_master_done && !IsStuck(s, Adjustment::kOffsetMaster);
  out.offset_slave_busy = !out.offset_slave_done && !IsStuck(s, Adjustment::kOffsetSlave);
  out.scaling_master_busy = !out.scaling_master_done && !IsStuck(s, Adjustment::kScalingMaster);
  out.scaling_slave_busy = !out.scaling_slave_done && !IsStuck(s, Adjustment::kScalingSlave);
}

}  // namespace takt::flexcam
