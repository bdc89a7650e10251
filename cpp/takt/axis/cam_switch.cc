#include "takt/axis/cam_switch.h"

#include <cmath>

#include "takt/axis/fit.h"
#include "takt/axis/sequence.h"
#include "takt/core/describe.h"

namespace takt::axis {

namespace {

constexpr double kCycleRounding = 1e-6;  // of a cycle: a duration of whole cycles is that many

// How far `x` is past `edge` in this sense; rotary: in [0, modulus), but for rounding.
double Past(const CamSwitchInputs& in, double edge, double x) {
  const double past = in.sense * (x - edge);
  if (in.modulus <= 0) return past;
  const double slack = Rounding(x);
  return past - in.modulus * std::floor((past + slack) / in.modulus);
}

double Width(const CamSwitchInputs& in, const CamSwitch& sw) {
  const double width = *sw.last_on_position - sw.first_on_position;
  return in.modulus > 0 && width < 0 ? width + in.modulus : width;
}

double Apart(const CamSwitchInputs& in, double a, double b) {
  return std::abs(in.modulus > 0 ? std::remainder(a - b, in.modulus) : a - b);
}

// Where the axis stands to a switch, with the track's lead time.
struct Sight {
  double past = 0;       // u behind the end at which it enters
  bool entered = false;  // in this cycle
};

Sight Look(const CamSwitch& sw, const CamTrack& track, const CamSwitchInputs& in, const CamSwitchState& s) {
  const double x = in.position + in.velocity * track.on_lead_s;
  const double before = in.position - in.step + s.velocity_before * track.on_lead_s;
  const double entry = in.sense > 0 ? sw.first_on_position : sw.last_on_position.value_or(sw.first_on_position);
  const double past = Past(in, entry, x);
  const double travelled = in.sense * (x - before);
  const double slack = Rounding(x);
  return {past, s.started && travelled > 0 && past >= -slack && past < travelled - slack};
}

bool PositionSwitch(const CamSwitch& sw, const CamTrack& track, const CamSwitchInputs& in, const Sight& sight) {
  const double width = Width(in, sw) + in.sense * in.velocity * (track.on_lead_s - track.off_lead_s);
  const double slack = Rounding(in.position);
  const bool inside = sight.past >= -slack && sight.past <= width + slack;
  return inside || (sight.entered && width >= 0);
}

bool RunsThatWay(const CamSwitch& sw, int sense) {
  return sw.direction == CamDirection::kBoth || (sw.direction == CamDirection::kPositive) == (sense > 0);
}

bool IsOn(const CamSwitch& sw, const CamTrack& track, const CamSwitchInputs& in, std::size_t i, CamSwitchState& s) {
  const std::uint64_t bit = std::uint64_t{1} << i;
  const bool that_way = RunsThatWay(sw, in.sense);
  const Sight sight = Look(sw, track, in, s);
  const bool was = (s.closed & bit) != 0;
  if (sw.mode == CamSwitchMode::kTime) {
    const auto now = static_cast<double>(in.cycle);
    if (that_way && sight.entered) {
      s.mark[i] = now + std::ceil(sw.duration_s / in.period_s - kCycleRounding);
      return true;
    }
    return was && now < s.mark[i];
  }
  const bool on = that_way && PositionSwitch(sw, track, in, sight);
  if (on == was) return on;
  if ((s.marked & bit) != 0 && Apart(in, in.position, s.mark[i]) < track.hysteresis) return was;
  s.marked |= bit;
  s.mark[i] = in.position;
  return on;
}

CamTrack OptionsOf(const CamSwitches& list, std::int32_t track) {
  for (const CamTrack& options : list.tracks) {
    if (options.track == track) return options;
  }
  return {.track = track};
}

}  // namespace

std::uint32_t Step(const CamSwitches& list, const CamSwitchInputs& in, CamSwitchState& s) noexcept {
  std::uint32_t outputs = 0;
  std::uint64_t on = 0;
  for (std::size_t i = 0; i < list.switches.size() && i < kMaxCamSwitches; ++i) {
    const CamSwitch& sw = list.switches[i];
    if (!IsOn(sw, OptionsOf(list, sw.track), in, i, s)) continue;
    on |= std::uint64_t{1} << i;
    outputs |= std::uint32_t{1} << (sw.track - 1);
  }
  s.closed = on;
  s.velocity_before = in.velocity;
  s.started = true;
  return outputs;
}

std::uint32_t SwitchCams(const Context& c, State& s) noexcept {
  CamSwitchState& cams = s.cam_switch;
  const bool set = cams.source == MasterSource::kSetValue;
  CamSwitchInputs in;
  in.position = set ? s.setpoint.position : s.actual.position;
  in.step = set ? s.setpoint.position - s.due : s.probe.step;
  in.velocity = set ? s.setpoint.velocity : s.actual.velocity;
  in.sense = in.velocity == 0 ? s.last_sense : in.velocity > 0 ? 1 : -1;
  in.modulus = c.params.rotary() ? c.params.modulus : 0;
  in.cycle = c.cycle.count;
  in.period_s = c.cycle.period_s;
  return Step(c.machine.cam_switches[static_cast<std::size_t>(cams.list)], in, cams) & cams.enable_mask;
}

Status CarryOut(const Context& c, Ticket ticket, const DigitalCamSwitch& command, State& s) noexcept {
  std::int32_t list = -1;
  for (std::size_t i = 0; i < c.machine.cam_switches.size(); ++i) {
    if (c.machine.cam_switches[i].name == command.switches.view()) list = static_cast<std::int32_t>(i);
  }
  if (list < 0) return Status::Failed(ErrorId::kUnknownTarget);
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

void describe(Enumeration<CamDirection>& e) {
  e.about("In which sense of travel a cam switch works.");
  e.value(CamDirection::kBoth, "both", "Both.");
  e.value(CamDirection::kPositive, "positive", "Upwards only.");
  e.value(CamDirection::kNegative, "negative", "Downwards only.");
}

void describe(Enumeration<CamSwitchMode>& e) {
  e.about("What ends a cam switch.");
  e.value(CamSwitchMode::kPosition, "position", "The end of its range.");
  e.value(CamSwitchMode::kTime, "time", "Its duration.");
}

void describe(Description<CamSwitch>& d) {
  using S = CamSwitch;
  d.about("A range of positions, or a position and a time, in which a track is on.");
  d.required<&S::track>(between(1, kMaxTracks), "Which track: bit track - 1 of cam_outputs.");
  d.required<&S::first_on_position>(unit::u, "Lower end of the range.");
  d.defaulted<&S::last_on_position>(unit::u,
                                    "Upper end of the range; below the first on rotary axes: across 0. In time mode "
                                    "where it begins downwards; unset: "
                                    "at first_on_position too.");
  d.defaulted<&S::direction>("In which sense of travel.");
  d.defaulted<&S::mode>("What ends it.");
  d.defaulted<&S::duration_s>(unit::s, not_negative, "Time mode: how long it is on.");
  d.rule<&S::last_on_position>("must be given, but in time mode",
                               [](const S& s) { return s.last_on_position || s.mode == CamSwitchMode::kTime; });
  d.rule<&S::duration_s>("must be above 0 in time mode",
                         [](const S& s) { return s.duration_s > 0 || s.mode == CamSwitchMode::kPosition; });
}

void describe(Description<CamTrack>& d) {
  using T = CamTrack;
  d.about("Options of one track of cam switches.");
  d.required<&T::track>(between(1, kMaxTracks), "Which track.");
  d.defaulted<&T::on_lead_s>(unit::s, between(-10, 10), "Switches on so much earlier; negative: later.");
  d.defaulted<&T::off_lead_s>(unit::s, between(-10, 10),
                              "Switches off so much earlier; negative: later. Not in time mode.");
  d.defaulted<&T::hysteresis>(
      unit::u, not_negative,
      "Having switched, a switch stays as it is until the axis is so far from there. Not in time mode.");
}

void describe(Description<CamSwitches>& d) {
  using L = CamSwitches;
  d.about("A list of cam switches, for any axis (MC_DigitalCamSwitch).");
  d.required<&L::name>("How commands call it.");
  d.defaulted<&L::tracks>("Options of tracks, where they have any.");
  d.required<&L::switches>("The switches, 64 at most.");
  d.rule<&L::switches>("must be 64 at most", [](const L& l) { return l.switches.size() <= kMaxCamSwitches; });
}

void describe(Description<CamSwitchState>& d) {
  using S = CamSwitchState;
  d.about("Cam switches of an axis.");
  d.internal<&S::ticket>("Of the command.");
  d.internal<&S::list>("Which list of the machine; -1: off.");
  d.internal<&S::enable_mask>("A bit for each track.");
  d.internal<&S::source>("Set point or measured position.");
  d.internal<&S::started>("There was a cycle before.");
  d.internal<&S::velocity_before>(unit::u_s, "In the cycle before.");
  d.internal<&S::closed>("A bit for each switch.");
  d.internal<&S::marked>("A bit for each switch that has switched.");
  d.internal<&S::mark>("Where each switched, or in which cycle it goes off.");
}

}  // namespace takt::axis
