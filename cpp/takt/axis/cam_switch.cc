#include "takt/axis/cam_switch.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "takt/axis/fit.h"
#include "takt/axis/sequence.h"
#include "takt/core/describe.h"

namespace takt::axis {

namespace {

constexpr double kCycleRounding = 1e-6;  // of a cycle: rounding of durations that are whole cycles

// A displacement of the compared position in one sense of travel; none if its length is not positive.
struct Way {
  double from = 0, to = 0;
  int sense = 1;

  double length() const { return sense * (to - from); }
};

// The motion of the axis between two cycles.
struct Travel {
  int sense = 1;
  double velocity = 0;  // [u/s] in that sense; 0 if the axis moves against it
  bool turned = false;
  double turning_point = 0;
};

Travel Follow(const CamSwitchInputs& in, CamSwitchState& s) {
  if (!s.started) {
    s.sense = in.sense < 0 ? -1 : 1;
    s.extreme = in.position;
  }
  Travel travel;
  travel.turning_point = s.extreme;
  const double way = s.sense * (in.position - s.extreme);
  travel.turned = way < -Rounding(in.position);
  if (travel.turned) {
    s.sense = static_cast<std::int8_t>(-s.sense);
    s.turned = ~std::uint64_t{0};
  }
  if (travel.turned || way > 0) s.extreme = in.position;
  travel.sense = s.sense;
  travel.velocity = s.sense * in.velocity > 0 ? in.velocity : 0;
  return travel;
}

// The same for a switch in all cycles, so that a position short of an edge in one cycle is so in the next, too.
double Slack(const CamSwitchInputs& in, const CamSwitch& sw) {
  const double last = sw.last_on_position.value_or(0);
  return Rounding(std::max({in.modulus, std::abs(sw.first_on_position), std::abs(last)}));
}

// Returns how far `x` [u] is past the end at which the range is entered in this sense; where positions repeat: in [0,
// modulus), but for rounding.
double Past(const CamSwitchInputs& in, const CamSwitch& sw, int sense, double x) {
  const double entry = sense > 0 ? sw.first_on_position : sw.last_on_position.value_or(sw.first_on_position);
  const double past = sense * (x - entry);
  return in.modulus > 0 ? past - in.modulus * std::floor((past + Slack(in, sw)) / in.modulus) : past;
}

double Width(const CamSwitchInputs& in, const CamSwitch& sw) {
  const double width = *sw.last_on_position - sw.first_on_position;
  return in.modulus > 0 && width < 0 ? width - in.modulus * std::floor(width / in.modulus) : width;
}

double Apart(const CamSwitchInputs& in, double a, double b) {
  return std::abs(in.modulus > 0 ? std::remainder(a - b, in.modulus) : a - b);
}

bool RunsThatWay(const CamSwitch& sw, int sense) {
  return sw.direction == CamDirection::kBoth || (sw.direction == CamDirection::kPositive) == (sense > 0);
}

bool Enters(const CamSwitchInputs& in, const CamSwitch& sw, const Way& way) {
  if (way.length() <= 0 || !RunsThatWay(sw, way.sense)) return false;
  const double past = Past(in, sw, way.sense, way.to);
  const double slack = Slack(in, sw);
  return past >= -slack && past < way.length() - slack;
}

// Advances `reach`, but never back, and returns its displacement.
Way Advance(double to, int sense, double& reach) {
  const Way way{reach, to, sense};
  if (way.length() > 0) reach = to;
  return way;
}

// Returns true if the axis entered the range since the previous cycle.
bool Enters(const CamSwitchInputs& in, const CamSwitch& sw, const Travel& travel, double x, bool started,
            double& reach) {
  if (!started) {
    reach = x;
    return false;
  }
  bool enters = false;
  if (travel.turned) {
    enters = Enters(in, sw, Advance(travel.turning_point, -travel.sense, reach));
    reach = travel.turning_point;
  }
  return Enters(in, sw, Advance(x, travel.sense, reach)) || enters;
}

bool Inside(const CamSwitchInputs& in, const CamSwitch& sw, int sense, double x, double width) {
  const double past = Past(in, sw, sense, x);
  const double slack = Slack(in, sw);
  return RunsThatWay(sw, sense) && past >= -slack && past <= width + slack;
}

bool IsOn(const CamSwitch& sw, const CamTrack& track, const CamSwitchInputs& in, const Travel& travel, std::size_t i,
          CamSwitchState& s) {
  const std::uint64_t bit = std::uint64_t{1} << i;
  const double x = in.position + travel.velocity * track.on_lead_s;
  const bool enters = Enters(in, sw, travel, x, s.started, s.reach[i]);
  if (Apart(in, in.position, s.mark[i]) >= track.hysteresis) s.marked &= ~bit;
  const bool held = (s.marked & s.turned & bit) != 0;
  const bool was = (s.closed & bit) != 0;
  const auto mark = [&] {
    s.mark[i] = in.position;
    s.marked |= bit;
    s.turned &= ~bit;
  };
  if (sw.mode == CamSwitchMode::kTime) {
    const auto now = static_cast<double>(in.cycle);
    if (!enters || held) return was && now < s.end_cycle[i];
    mark();
    s.end_cycle[i] = now + std::ceil(sw.duration_s / in.period_s - kCycleRounding);
    return true;
  }
  const double width = Width(in, sw) + travel.sense * travel.velocity * (track.on_lead_s - track.off_lead_s);
  const bool on = Inside(in, sw, travel.sense, x, width) || (enters && width >= 0);
  if (on == was || held) return was;
  mark();
  return on;
}

CamTrack OptionsOf(const CamSwitches& list, std::int32_t track) {
  for (const CamTrack& options : list.tracks) {
    if (options.track == track) return options;
  }
  return {.track = track};
}

// Returns the first switch whose range ends below its beginning; null if there is none.
const CamSwitch* EndsBelow(const CamSwitches& list) {
  const auto backwards = [](const CamSwitch& sw) {
    return sw.last_on_position.value_or(sw.first_on_position) < sw.first_on_position;
  };
  const auto found = std::ranges::find_if(list.switches, backwards);
  return found == list.switches.end() ? nullptr : &*found;
}

// Returns true if a turn of the axis is a whole number of the list's modulus. A list without one repeats as its axis
// does.
bool FitsTurn(const CamSwitches& list, const AxisParams& params) {
  if (!params.rotary() || !list.modulus) return true;
  const double times = params.modulus / *list.modulus;
  return std::round(times) >= 1 && std::abs(times - std::round(times)) <= Rounding(times);
}

bool CanSwitch(const CamSwitches& list, const AxisParams& params) {
  const bool repeats = params.rotary() || list.modulus;
  return FitsTurn(list, params) && (repeats || !EndsBelow(list));
}

}  // namespace

std::uint32_t Step(const CamSwitches& list, const CamSwitchInputs& in, CamSwitchState& s) noexcept {
  std::uint32_t outputs = 0;
  std::uint64_t on = 0;
  const Travel travel = Follow(in, s);
  for (std::size_t i = 0; i < list.switches.size() && i < kMaxCamSwitches; ++i) {
    const CamSwitch& sw = list.switches[i];
    if (!IsOn(sw, OptionsOf(list, sw.track), in, travel, i, s)) continue;
    on |= std::uint64_t{1} << i;
    outputs |= std::uint32_t{1} << (sw.track - 1);
  }
  s.closed = on;
  s.started = true;
  return outputs;
}

std::uint32_t SwitchCams(const Context& c, State& s) noexcept {
  CamSwitchState& cams = s.cam_switch;
  const CamSwitches& list = c.machine.cam_switches[static_cast<std::size_t>(cams.list)];
  const KinematicState& x = cams.source == MasterSource::kSetValue ? s.setpoint : s.actual;
  CamSwitchInputs in;
  in.position = x.position;
  in.velocity = x.velocity;
  in.sense = s.last_sense;
  in.modulus = list.modulus.value_or(c.params.turn());
  in.cycle = c.cycle.count;
  in.period_s = c.cycle.period_s;
  const std::uint32_t outputs = Step(list, in, cams) & cams.enable_mask;
  // After an encoder error the next position is unrelated to the last one.
  const bool measured = cams.source == MasterSource::kActualValue || !s.loop_closed;
  if (measured && s.encoder_error) cams.started = false;
  return outputs;
}

void Shift(double by, CamSwitchState& s) noexcept {
  s.extreme += by;
  for (double& mark : s.mark) mark += by;
  for (double& reach : s.reach) reach += by;
}

Status CarryOut(const Context& c, Ticket ticket, const DigitalCamSwitch& command, State& s) noexcept {
  std::int32_t list = -1;
  for (std::size_t i = 0; i < c.machine.cam_switches.size(); ++i) {
    if (c.machine.cam_switches[i].name == command.switches.view()) list = static_cast<std::int32_t>(i);
  }
  if (list < 0) return Status::Failed(ErrorId::kUnknownTarget);
  if (!CanSwitch(c.machine.cam_switches[static_cast<std::size_t>(list)], c.params)) {
    return Status::Failed(ErrorId::kParameter);
  }
  CamSwitchState& cams = s.cam_switch;
  if (cams.list >= 0) Report(c, cams.ticket, FeedbackState::kAborted);
  Report(c, ticket, FeedbackState::kActive);
  if (!command.enable) {
    cams = CamSwitchState{};
    Report(c, ticket, FeedbackState::kDone);
    return Status::Ok();
  }
  if (cams.list != list || cams.source != command.source) cams = CamSwitchState{};
  cams.ticket = ticket;
  cams.list = list;
  cams.enable_mask = command.enable_mask;
  cams.source = command.source;
  return Status::Ok();
}

std::string DiagnoseCamSwitches(const CamSwitches& list, const AxisParams& params) {
  if (CanSwitch(list, params)) return {};
  std::ostringstream text;
  if (!FitsTurn(list, params)) {
    text << "expected a modulus that a turn of axis " << params.name << " (" << params.modulus
         << ") is a whole number of, found " << *list.modulus;
  } else {
    const CamSwitch& sw = *EndsBelow(list);
    text << "expected last_on_position not below first_on_position, as axis " << params.name
         << " is linear and the list has no modulus, found " << *sw.last_on_position << " below "
         << sw.first_on_position;
  }
  return text.str();
}

void describe(Enumeration<CamDirection>& e) {
  e.about("Sense of travel in which a cam switch acts.");
  e.value(CamDirection::kBoth, "both", "In both senses.");
  e.value(CamDirection::kPositive, "positive", "Upwards only.");
  e.value(CamDirection::kNegative, "negative", "Downwards only.");
}

void describe(Enumeration<CamSwitchMode>& e) {
  e.about("Condition that ends a cam switch.");
  e.value(CamSwitchMode::kPosition, "position", "The end of its range is reached.");
  e.value(CamSwitchMode::kTime, "time", "Its duration has elapsed.");
}

void describe(Description<CamSwitch>& d) {
  using S = CamSwitch;
  d.about("A range of positions, or a position and a time, in which a track is on.");
  d.required<&S::track>(between(1, kMaxTracks), "Number of the track: bit track - 1 of cam_outputs.");
  d.required<&S::first_on_position>(unit::u, "Lower end of the range.");
  d.defaulted<&S::last_on_position>(
      unit::u,
      "Upper end of the range; below the first, on rotary axes or with a modulus: the range includes 0. In time mode "
      "the position at which it switches on downwards; unset: first_on_position.");
  d.defaulted<&S::direction>("Sense of travel in which it acts.");
  d.defaulted<&S::mode>("Condition that ends it.");
  d.defaulted<&S::duration_s>(unit::s, not_negative, "Time mode: duration for which it is on.");
  d.rule<&S::last_on_position>("must be given, but in time mode",
                               [](const S& s) { return s.last_on_position || s.mode == CamSwitchMode::kTime; });
  d.rule<&S::duration_s>("must be above 0 in time mode",
                         [](const S& s) { return s.duration_s > 0 || s.mode == CamSwitchMode::kPosition; });
}

void describe(Description<CamTrack>& d) {
  using T = CamTrack;
  d.about("Options of one track of cam switches.");
  d.required<&T::track>(between(1, kMaxTracks), "Number of the track.");
  d.defaulted<&T::on_lead_s>(unit::s, between(-10, 10), "Time by which it switches on earlier; negative: later.");
  d.defaulted<&T::off_lead_s>(unit::s, between(-10, 10),
                              "Time by which it switches off earlier; negative: later. Unused in time mode.");
  d.defaulted<&T::hysteresis>(unit::u, not_negative,
                              "After the axis has reversed, a switch keeps its state until the axis is this far from "
                              "its last switching position. In time mode: the time does not restart until then.");
}

void describe(Description<CamSwitches>& d) {
  using L = CamSwitches;
  d.about("A list of cam switches, for any axis (MC_DigitalCamSwitch).");
  d.required<&L::name>("Name of the list in commands.");
  d.defaulted<&L::modulus>(unit::u, positive,
                           "Distance after which positions repeat; unset: as for the axis. For linear axes, or for "
                           "several repetitions in a turn.");
  d.defaulted<&L::tracks>("Options of individual tracks.");
  d.required<&L::switches>("Switches, 64 at most.");
  d.rule<&L::switches>("must be 64 at most", [](const L& l) { return l.switches.size() <= kMaxCamSwitches; });
}

void describe(Description<CamSwitchState>& d) {
  using S = CamSwitchState;
  d.about("Cam switches of an axis.");
  d.internal<&S::ticket>("Ticket of the command.");
  d.internal<&S::list>("Index among the machine's lists; -1: off.");
  d.internal<&S::enable_mask>("Tracks that are enabled, a bit for each.");
  d.internal<&S::source>("Set point or measured position.");
  d.internal<&S::started>("A cycle has been computed before.");
  d.internal<&S::sense>("Sense of travel.");
  d.internal<&S::extreme>(unit::u, "Furthest position in this sense of travel.");
  d.internal<&S::closed>("Switches that are on, a bit for each.");
  d.internal<&S::marked>("Switches that have switched, with the axis still within the hysteresis, a bit for each.");
  d.internal<&S::turned>("Switches after which the axis has reversed, a bit for each.");
  d.internal<&S::mark>("Position at which each switch switched last.");
  d.internal<&S::reach>("Furthest position compared in this sense of travel.");
  d.internal<&S::end_cycle>("Time mode: cycle in which each switch switches off.");
}

}  // namespace takt::axis
