// Outputs that an axis switches by its position (MC_DigitalCamSwitch, AX-50): a pure function of where it is, how it
// got there and how fast it is.
//
// A switch is on from where the axis enters its range to where it leaves it; which end is which depends on the sense of
// travel. The track's lead times shift both: the position compared is where the axis will be after that time at its
// present speed. The moment within a cycle is not resolved: an output has in a cycle the value that belongs to the
// position of that cycle, and a range jumped over from one cycle to the next is on for one of them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "takt/axis/commands/probe.h"
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
  std::optional<double> last_on_position{};  // u; below the first one: across 0 of a rotary axis
  CamDirection direction = CamDirection::kBoth;
  CamSwitchMode mode = CamSwitchMode::kPosition;
  double duration_s = 0;  // time mode: how long it is on from entering the range; entered again: from then
};

struct CamTrack {
  std::int32_t track = 1;
  double on_lead_s = 0;   // s, switches on so much earlier; negative: later
  double off_lead_s = 0;  // s, the same off; not in time mode
  double hysteresis = 0;  // u, >= 0: having switched, a switch stays until the axis is so far away; not in time mode
};

// A list of the machine file.
struct CamSwitches {
  std::string name;
  std::vector<CamTrack> tracks;  // those with options
  std::vector<CamSwitch> switches;
};

struct CamSwitchInputs {
  double position = 0;  // u, unwrapped
  double step = 0;      // u, since the cycle before
  double velocity = 0;  // u/s
  int sense = 1;        // of travel; at standstill of the last motion
  double modulus = 0;   // u, rotary axes; 0: linear
  std::uint64_t cycle = 0;
  double period_s = 0.001;
};

struct CamSwitchState {
  Ticket ticket = 0;
  std::int32_t list = -1;  // of the machine's lists; -1: off
  std::uint32_t enable_mask = 0;
  MasterSource source = MasterSource::kSetValue;

  bool started = false;                        // there was a cycle before
  double velocity_before = 0;                  // u/s
  std::uint64_t closed = 0;                    // a bit for each switch
  std::uint64_t marked = 0;                    // a bit for each switch: it has switched, at `mark`
  std::array<double, kMaxCamSwitches> mark{};  // u, where it last switched; time mode: the cycle in which it goes off
};

// One cycle; the outputs, before the enable mask.
std::uint32_t Step(const CamSwitches& params, const CamSwitchInputs& inputs, CamSwitchState& state) noexcept;

// For an axis: after its set point is known.
std::uint32_t SwitchCams(const Context& context, State& state) noexcept;
// Active until it is given again. Error: kUnknownTarget where there is no such list.
Status CarryOut(const Context& context, Ticket ticket, const DigitalCamSwitch& command, State& state) noexcept;

void describe(Enumeration<CamDirection>&);
void describe(Enumeration<CamSwitchMode>&);
void describe(Description<CamSwitch>&);
void describe(Description<CamTrack>&);
void describe(Description<CamSwitches>&);
void describe(Description<CamSwitchState>&);

}  // namespace takt::axis
