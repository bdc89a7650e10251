// Outputs switched by the position of an axis (MC_DigitalCamSwitch, AX-50, CAM-72): a pure function of position,
// history and velocity. Any axis, master or slave, can have them, by its set point or its actual position.
//
// A switch is on from the point where the axis enters its range to the point where it leaves it; the sense of travel
// decides which end is which. The lead times of the track shift both: the position compared is the one that the axis
// will have after that time at its present velocity. There is no resolution within a cycle: the output of a cycle
// belongs to the position of that cycle, and a range that is skipped between two cycles is on for one cycle.
//
// A range is entered between the positions of the previous cycle and of this one, so each passage counts once, at any
// velocity. With lead times, the furthest position compared since the last reversal counts, so that changes of velocity
// alone neither repeat nor lose a passage. A passage that a negative lead time still delays when the axis reverses
// counts at the reversal.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "takt/axis/commands/probe.h"
#include "takt/axis/params.h"
#include "takt/core/describe_fwd.h"
#include "takt/core/feedback.h"
#include "takt/core/status.h"

namespace takt::axis {

struct Context;
struct State;

inline constexpr int kMaxTracks = 32;
inline constexpr std::size_t kMaxCamSwitches = 64;

enum class CamDirection : std::uint8_t { kBoth, kPositive, kNegative };
enum class CamSwitchMode : std::uint8_t { kPosition, kTime };

struct CamSwitch {
  std::int32_t track = 1;        // 1 to 32: bit track - 1 of the outputs; on while any of the track's switches is
  double first_on_position = 0;  // [u]
  std::optional<double> last_on_position{};  // [u] less than the first one: across 0, where positions repeat
  CamDirection direction = CamDirection::kBoth;
  CamSwitchMode mode = CamSwitchMode::kPosition;
  double duration_s = 0;  // [s] time mode: on for this long after entering the range; each entry restarts it
};

struct CamTrack {
  std::int32_t track = 1;
  double on_lead_s = 0;   // [s] switches on this much earlier; negative: later
  double off_lead_s = 0;  // [s] switches off this much earlier; negative: later; unused in time mode
  // [u] >= 0: after a switch has switched and the axis has reversed, the switch does not change until the axis is this
  // far from the switching position. In time mode: the time does not restart until then.
  double hysteresis = 0;
};

// A list of the machine file.
struct CamSwitches {
  std::string name;
  // [u] distance after which positions repeat; unset: that of the axis. For linear axes that follow a periodic cam.
  std::optional<double> modulus{};
  std::vector<CamTrack> tracks;  // tracks with options
  std::vector<CamSwitch> switches;
};

struct CamSwitchInputs {
  double position = 0;  // [u] unwrapped
  double velocity = 0;  // [u/s]
  int sense = 1;        // sense of the last motion, used in the first cycle
  double modulus = 0;   // [u] distance after which positions repeat; 0: they do not
  std::uint64_t cycle = 0;
  double period_s = 0.001;
};

struct CamSwitchState {
  Ticket ticket = 0;
  std::int32_t list = -1;  // index among the machine's lists; -1: off
  std::uint32_t enable_mask = 0;
  MasterSource source = MasterSource::kSetValue;

  bool started = false;      // a cycle has been computed before
  std::int8_t sense = 1;     // sense of travel
  double extreme = 0;        // [u] furthest position in this sense of travel
  std::uint64_t closed = 0;  // a bit for each switch: it is on
  std::uint64_t marked = 0;  // a bit for each: switched, and the axis has stayed within `hysteresis` of `mark` since
  std::uint64_t turned = 0;  // a bit for each: the axis has reversed since it switched
  std::array<double, kMaxCamSwitches> mark{};       // [u] where it switched last
  std::array<double, kMaxCamSwitches> reach{};      // [u] furthest position compared in this sense of travel
  std::array<double, kMaxCamSwitches> end_cycle{};  // time mode: cycle in which it switches off
};

// Returns the outputs of one cycle, before the enable mask.
std::uint32_t Step(const CamSwitches& params, const CamSwitchInputs& inputs, CamSwitchState& state) noexcept;

// Returns the outputs of an axis in this cycle. Requires: its set point of this cycle.
std::uint32_t SwitchCams(const Context& context, State& state) noexcept;
// Adds `by` [u] to all positions (see ShiftCoordinates).
void Shift(double by, CamSwitchState& state) noexcept;
// Active until superseded. Returns kUnknownTarget if there is no such list, kParameter if the axis cannot have it.
Status CarryOut(const Context& context, Ticket ticket, const DigitalCamSwitch& command, State& state) noexcept;

// Returns why this axis cannot have the list; empty if it can. Reasons: a range ends below its beginning although
// positions do not repeat, or the turn of the axis is no multiple of the list's modulus.
std::string DiagnoseCamSwitches(const CamSwitches& list, const AxisParams& params);

void describe(Enumeration<CamDirection>&);
void describe(Enumeration<CamSwitchMode>&);
void describe(Description<CamSwitch>&);
void describe(Description<CamTrack>&);
void describe(Description<CamSwitches>&);
void describe(Description<CamSwitchState>&);

}  // namespace takt::axis
