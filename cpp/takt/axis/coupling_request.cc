#include "takt/axis/coupling_request.h"

#include <cmath>

#include "takt/axis/request_builder.h"

namespace takt::axis {

namespace {

struct RatioFields {
  const char* numerator;
  const char* denominator;
};

bool Ratio(const RequestBuilder& m, const RatioFields& names, double numerator, double denominator, double& out) {
  out = numerator / denominator;
  return m.In(names.numerator, numerator, -kMaxPosition, kMaxPosition) &&
         m.In(names.denominator, denominator, std::numeric_limits<double>::min(), kMaxPosition) &&
         m.In(names.numerator, out, -kMaxPosition, kMaxPosition);
}

constexpr RatioFields kRatio = {"ratio_numerator", "ratio_denominator"};
constexpr RatioFields kRatio1 = {"ratio_numerator1", "ratio_denominator1"};
constexpr RatioFields kRatio2 = {"ratio_numerator2", "ratio_denominator2"};

bool Term(const RequestBuilder& m, const Name& name, MasterSource source, double ratio, CouplingTerm& out) {
  out.name = name;
  out.source = source;
  out.ratio = ratio;
  if (name.empty() || name.view() == m.params.name || source > MasterSource::kActualValue) {
    m.why.field = source > MasterSource::kActualValue ? "source" : "master";
    return false;
  }
  return true;
}

bool Filter(const RequestBuilder& m, const std::optional<double>& filter_s, CouplingTerm& out) {
  constexpr double kLongest = 10;  // [s]
  if (filter_s) out.filter_s = *filter_s;
  return m.In("master_filter", filter_s.value_or(0), 0, kLongest);
}

}  // namespace

bool Fill(const RequestBuilder& m, const GearIn& c) {
  m.r.kind = RequestKind::kGearIn;
  m.r.buffer_mode = c.buffer_mode;
  m.r.velocity = m.params.limits.velocity;
  double ratio = 0;
  return Ratio(m, kRatio, c.ratio_numerator, c.ratio_denominator, ratio) &&
         Term(m, c.master, c.source, ratio, m.r.coupling.terms[0]) &&
         Filter(m, c.master_filter, m.r.coupling.terms[0]) && m.Ramps(c);
}

bool Fill(const RequestBuilder& m, const GearInPos& c) {
  m.r.kind = RequestKind::kGearInPos;
  m.r.buffer_mode = c.buffer_mode;
  CouplingRequest& out = m.r.coupling;
  out.master_sync_position = c.master_sync_position;
  out.slave_sync_position = c.slave_sync_position;
  out.master_start_distance = c.master_start_distance.value_or(-1);
  out.sync_mode = c.sync_mode;
  double ratio = 0;
  if (c.sync_mode > SyncMode::kSlowDown) {
    m.why.field = "sync_mode";
    return false;
  }
  return m.In("master_sync_position", c.master_sync_position, -kMaxPosition, kMaxPosition) &&
         m.In("slave_sync_position", c.slave_sync_position, -kMaxPosition, kMaxPosition) &&
         m.In("master_start_distance", c.master_start_distance.value_or(0), 0, kMaxPosition) &&
         Ratio(m, kRatio, c.ratio_numerator, c.ratio_denominator, ratio) &&
         Term(m, c.master, c.source, ratio, out.terms[0]) && Filter(m, c.master_filter, out.terms[0]) &&
         m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}

bool Fill(const RequestBuilder& m, const CombineAxes& c) {
  m.r.kind = RequestKind::kCombineAxes;
  m.r.buffer_mode = c.buffer_mode;
  double first = 0;
  double second = 0;
  if (c.mode > CombineMode::kSubtract) {
    m.why.field = "mode";
    return false;
  }
  return Ratio(m, kRatio1, c.ratio_numerator1, c.ratio_denominator1, first) &&
         Ratio(m, kRatio2, c.ratio_numerator2, c.ratio_denominator2, second) &&
         Term(m, c.master1, c.source1, first, m.r.coupling.terms[0]) &&
         Term(m, c.master2, c.source2, c.mode == CombineMode::kAdd ? second : -second, m.r.coupling.terms[1]) &&
         m.Take("velocity", c.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(c);
}

bool Fill(const RequestBuilder& m, const CamTableSelect& c) {
  m.r.table.name = c.cam;
  if (c.cam.empty()) m.why.field = "cam";
  return !c.cam.empty();
}

bool Fill(const RequestBuilder& m, const CamIn& c) {
  m.r.kind = RequestKind::kCamIn;
  m.r.buffer_mode = c.buffer_mode;
  if (c.start_mode > CamStart::kRampIn || c.cam.empty()) {
    m.why.field = c.cam.empty() ? "cam" : "start_mode";
    return false;
  }
  const bool waits = c.master_sync_position || c.master_start_distance;
  CouplingRequest& out = m.r.coupling;
  out.master_sync_position = c.master_sync_position.value_or(0);
  out.at_sync_position = c.master_sync_position.has_value();
  out.master_start_distance = waits ? c.master_start_distance.value_or(0) : -1;
  out.master_offset = c.master_offset;
  out.master_absolute = c.master_absolute;
  out.slave_absolute = c.slave_absolute && c.start_mode != CamStart::kRelative;
  m.r.table = {.name = c.cam, .index = kNoTable, .time_scale = 1, .scale = c.slave_scaling, .offset = c.slave_offset};
  out.periodic = c.periodic;
  const auto takes_ramps = [&m](const CamIn& of) {
    return m.Take("velocity", of.velocity, m.params.limits.velocity, m.r.velocity) && m.Ramps(of);
  };
  return m.In("master_offset", c.master_offset, -kMaxPosition, kMaxPosition) &&
         m.In("slave_offset", c.slave_offset, -kMaxPosition, kMaxPosition) &&
         m.In("master_scaling", std::abs(c.master_scaling), 1 / kMaxPosition, kMaxPosition) &&
         m.In("slave_scaling", c.slave_scaling, -kMaxPosition, kMaxPosition) &&
         m.In("master_sync_position", out.master_sync_position, -kMaxPosition, kMaxPosition) &&
         m.In("master_start_distance", c.master_start_distance.value_or(0), 0, kMaxPosition) &&
         Term(m, c.master, c.source, c.master_scaling, out.terms[0]) &&
         (c.start_mode == CamStart::kRampIn ? takes_ramps(c) : takes_ramps(CamIn{}));
}

bool Fill(const RequestBuilder& m, const CamAdd& c) {
  if (c.cam.empty()) m.why.field = "cam";
  m.r.table = {.name = c.cam, .index = kNoTable, .time_scale = 1, .scale = c.slave_scaling, .offset = c.slave_offset};
  m.r.coupling.periodic = c.periodic;
  return !c.cam.empty() && m.In("master_offset", c.master_offset, -kMaxPosition, kMaxPosition) &&
         m.In("slave_offset", c.slave_offset, -kMaxPosition, kMaxPosition) &&
         m.In("master_scaling", std::abs(c.master_scaling), 1 / kMaxPosition, kMaxPosition) &&
         m.In("slave_scaling", c.slave_scaling, -kMaxPosition, kMaxPosition);
}

bool Fill(const RequestBuilder& m, const GearOut&) {
  m.r.kind = RequestKind::kLetGo;
  return m.Braking(Halt{});
}

bool Fill(const RequestBuilder& m, const CamOut&) {
  return Fill(m, GearOut{});
}

namespace {

// The limits of a shift are in the master's unit, so they are not compared with the axis' own: they must only be
// finite.
template <typename T>
bool Shift(const RequestBuilder& m, const T& c) {
  const auto above_zero = [&](const char* field, const std::optional<double>& value) {
    return !value || m.In(field, *value, std::numeric_limits<double>::min(), kMaxPosition);
  };
  return m.In("phase_shift", c.phase_shift, -kMaxPosition, kMaxPosition) && above_zero("velocity", c.velocity) &&
         above_zero("acceleration", c.acceleration) && above_zero("deceleration", c.deceleration) &&
         m.In("jerk", c.jerk.value_or(0), 0, std::numeric_limits<double>::max());
}

}  // namespace

bool Fill(const RequestBuilder& m, const PhasingAbsolute& c) {
  return Shift(m, c);
}
bool Fill(const RequestBuilder& m, const PhasingRelative& c) {
  return Shift(m, c);
}

void describe(Description<CouplingTerm>& d) {
  d.about("One master and its ratio.");
  d.internal<&CouplingTerm::filter_s>(
      unit::s, "Time constant of the filter of a measured master; negative: that of its encoder.");
  d.internal<&CouplingTerm::name>("Name of the master.");
  d.internal<&CouplingTerm::master>("Index of the master.");
  d.internal<&CouplingTerm::source>("Position of the master that is followed.");
  d.internal<&CouplingTerm::ratio>("Own units per master's unit.");
}

void describe(Description<CouplingRequest>& d) {
  using C = CouplingRequest;
  d.about("Parameters of a command that couples axes.");
  d.internal<&C::terms>("Its masters.");
  d.internal<&C::master_sync_position>("Position of the master, in its unit, at which both are in step.");
  d.internal<&C::slave_sync_position>(unit::u, "Position of this axis at which both are in step.");
  d.internal<&C::master_start_distance>(
      "Distance of the master before that at which synchronisation begins; negative: at once.");
  d.internal<&C::sync_mode>("How a rotary axis reaches that position.");
  d.internal<&C::master_offset>("Cams: added to x.");
  d.internal<&C::master_absolute>("Cams: x counts from the master's zero.");
  d.internal<&C::slave_absolute>("Cams: y counts from this axis' zero.");
  d.internal<&C::at_sync_position>("Cams: a position of the master was given.");
  d.internal<&C::periodic>("Cams: the cam repeats.");
}

}  // namespace takt::axis
