// Outputs that an axis switches by its position (MC_DigitalCamSwitch, AX-50, CAM-72): a pure function of where it is,
// how it got there and how fast it is. Any axis can have them, a master as well as a slave, by its set point or by what
// is measured.
//
// A switch is on from where the axis enters its range to where it leaves it; which end is which depends on the sense of
// travel. The track's lead times shift both: the position compared is where the axis will be after that time at its
// present speed. The moment within a cycle is not resolved: an output has in a cycle the value that belongs to the
// position of that cycle, and a range jumped over from one cycle to the next is on for one of them.
//
// Entering is what happens between the last cycle's position and this one's, so each passage is one, at any speed: with
// lead times the furthest place compared since the axis last turned round counts, so that changes of speed alone
// neither repeat nor lose one. What a lag still holds back when the axis turns round comes then.
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
  double first_on_position = 0;  // u
  std::optional<double> last_on_position{};  // u; below the first one: across 0 where positions repeat
  CamDirection direction = CamDirection::kBoth;
  CamSwitchMode mode = CamSwitchMode::kPosition;
  double duration_s = 0;  // time mode: how long it is on from entering the range; entered again: from then
};

struct CamTrack {
  std::int32_t track = 1;
  double on_lead_s = 0;   // s, switches on so much earlier; negative: later
  double off_lead_s = 0;  // s, the same off; not in time mode
  // u, >= 0: an axis that turns round after a switch has switched changes nothing until it is so far from there. In
  // time mode: the time does not begin again until then.
  double hysteresis = 0;
};

// A list of the machine file.
struct CamSwitches {
  std::string name;
  // u, positions repeat every so many; unset: as the axis' own do. For linear axes that a periodic cam follows.
  std::optional<double> modulus{};
  std::vector<CamTrack> tracks;  // those with options
  std::vector<CamSwitch> switches;
};

struct CamSwitchInputs {
  double position = 0;  // u, unwrapped
  double velocity = 0;  // u/s
  int sense = 1;        // of the last motion, for the first cycle
  double modulus = 0;   // u, positions repeat; 0: they do not
  std::uint64_t cycle = 0;
  double period_s = 0.001;
};

struct CamSwitchState {
  Ticket ticket = 0;
  std::int32_t list = -1;  // of the machine's lists; -1: off
  std::uint32_t enable_mask = 0;
  MasterSource source = MasterSource::kSetValue;

  bool started = false;      // there was a cycle before
  std::int8_t sense = 1;     // of travel
  double extreme = 0;        // u, how far it got that way
  std::uint64_t closed = 0;  // a bit for each switch, as are:
  std::uint64_t marked = 0;  // it has switched, and the axis has not been `hysteresis` away from there since ...
  std::uint64_t turned = 0;  // ... but has turned round
  std::array<double, kMaxCamSwitches> mark{};       // u, where it last switched
  std::array<double, kMaxCamSwitches> reach{};      // u, furthest place compared in this sense of travel
  std::array<double, kMaxCamSwitches> end_cycle{};  // time mode: in which it goes off
};

// One cycle; the outputs, before the enable mask.
std::uint32_t Step(const CamSwitches& params, const CamSwitchInputs& inputs, CamSwitchState& state) noexcept;

// For an axis: after its set point is known.
std::uint32_t SwitchCams(const Context& context, State& state) noexcept;
// Other numbers for where the axis is (see ShiftCoordinates).
void Shift(double by, CamSwitchState& state) noexcept;
// Active until it is given again. Error: kUnknownTarget where there is no such list, kParameter where the axis cannot
// have it.
Status CarryOut(const Context& context, Ticket ticket, const DigitalCamSwitch& command, State& state) noexcept;

// Why this axis cannot have this list: a range that ends below its beginning where positions do not repeat, or that
// repeats in another rhythm than a turn. Empty: it can.
std::string CannotSwitch(const CamSwitches& list, const AxisParams& params);

void describe(Enumeration<CamDirection>&);
void describe(Enumeration<CamSwitchMode>&);
void describe(Description<CamSwitch>&);
void describe(Description<CamTrack>&);
void describe(Description<CamSwitches>&);
void describe(Description<CamSwitchState>&);

}  // namespace takt::axis
