#include "takt/plant/servo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "takt/core/maths.h"

namespace takt::plant {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr int kProbeBisections = 24;  // of a step of the drive: to less than 1 ns

// Solution factors of a first-order motion v' = slope - rate (v - v0) after a time: v - v0 = slope * to_velocity, x -
// x0 - v0 t = slope * to_distance.
struct Reach {
  double to_velocity = 0;  // [s]
  double to_distance = 0;  // [s²]
};

Reach ReachAfter(double rate, double time) noexcept {
  const double ratio = rate * time;
  if (ratio < 1e-3) {  // the closed form would lose precision
    return {time * (1 - ratio / 2 * (1 - ratio / 3 * (1 - ratio / 4))),
            time * time / 2 * (1 - ratio / 3 * (1 - ratio / 4 * (1 - ratio / 5)))};
  }
  const double to_velocity = (1 - maths::Exp(-ratio)) / rate;
  return {to_velocity, (time - to_velocity) / rate};
}

// Returns the time after which to_velocity has the given value.
double TimeToReach(double rate, double to_velocity) noexcept {
  return rate > 0 ? -maths::Log1p(-rate * to_velocity) / rate : to_velocity;
}

// The equation of motion during one step of the drive, per unit of inertia:
// v' = clamp(gain (target - v) + bias, low, high) - load - viscous v - friction sign(v)
struct Law {
  double gain = 0;      // [1/s]; 0: no power
  double lag = 0;       // [s] 1 / gain
  double target = 0;    // [u/s]
  double bias = 0;      // [u/s²]
  double low = 0;       // [u/s²]
  double high = 0;      // [u/s²]
  double viscous = 0;   // [1/s]
  double friction = 0;  // [u/s²]
  double load = 0;      // [u/s²]

  double DriveAt(double v) const noexcept { return std::clamp(gain * (target - v) + bias, low, high); }
};

struct Motion {
  double position = 0;  // [u] of the motor
  double velocity = 0;  // [u/s] of the motor
  double load = 0;      // [u] position of the load
};

// Exact solution, piece by piece. v' depends on v alone and decreases with it, so v moves monotonically towards its
// equilibrium and crosses each boundary (torque limit, change of sign of friction) at most once: at most four pieces.
// `whole` is the reach of an undisturbed piece over the whole time. Inlined where every cycle needs it: a fifth of the
// servo's time.
[[gnu::always_inline]] inline void Advance(const Law& law, double time, const Reach& whole, Motion& m) noexcept {
  const bool powered = law.gain > 0;
  const double full_below = powered ? law.target + (law.bias - law.high) * law.lag : -kInfinite;
  const double full_above = powered ? law.target + (law.bias - law.low) * law.lag : kInfinite;
  double left = time;
  for (int piece = 0; piece < 4; ++piece) {
    const double v = m.velocity;
    const double push = law.DriveAt(v) - law.load - law.viscous * v;
    if (v == 0 && std::abs(push) <= law.friction) return;
    const double slope = push - std::copysign(law.friction, v == 0 ? push : v);

    const bool up = slope > 0;
    double border = up ? kInfinite : -kInfinite;
    bool full = true;
    if (up ? v < full_below : v > full_above) {
      border = up ? full_below : full_above;
    } else if (up ? v < full_above : v > full_below) {
      border = up ? full_above : full_below;
      full = false;
    }
    if (up ? (v < 0 && border > 0) : (v > 0 && border < 0)) border = 0;

    const double rate = law.viscous + (full ? 0 : law.gain);
    const Reach reach = !full && left == time ? whole : ReachAfter(rate, left);
    const double end = v + slope * reach.to_velocity;
    if (up ? end <= border : end >= border) {
      m.position += v * left + slope * reach.to_distance;
      m.velocity = end;
      return;
    }
    const double passed = std::min(TimeToReach(rate, (border - v) / slope), left);
    m.position += v * passed + slope * ReachAfter(rate, passed).to_distance;
    m.velocity = border;
    left -= passed;
  }
  m.position += m.velocity * left;
}

double FiniteOrZero(double x) noexcept {
  return std::isfinite(x) ? x : 0;
}

// Limited to the range of a 64-bit counter, with room for an origin.
std::int64_t Whole(double x) noexcept {
  return static_cast<std::int64_t>(std::clamp(x, -4e18, 4e18));
}

std::int64_t Nearest(double x) noexcept {
  return Whole(x + (x < 0 ? -0.5 : 0.5));
}

std::int64_t Floor(double x) noexcept {
  const std::int64_t whole = Whole(x);
  return whole - (static_cast<double>(whole) > x ? 1 : 0);
}

double CountsPerUnit(const ServoEncoder& encoder) noexcept {
  return encoder.inverted ? -encoder.increments_per_unit : encoder.increments_per_unit;
}

double EncoderPosition(const ServoEncoder& encoder, const ServoState& s) noexcept {
  return encoder.place == ServoEncoderPlace::kMotor ? s.motor_position : s.load_position;
}

std::int64_t CounterAt(const ServoEncoder& encoder, std::int64_t origin, double position, double noise) noexcept {
  return Nearest(position * CountsPerUnit(encoder) + noise) + origin;
}

std::uint32_t OnTheWire(const ServoEncoder& encoder, std::int64_t counter) noexcept {
  const auto word = static_cast<std::uint32_t>(counter);
  if (encoder.type == ServoEncoderType::kIncremental) return word;
  const std::uint32_t value = word & (~std::uint32_t{0} >> (32 - encoder.ssi_bits));
  return encoder.coding == ServoEncoderCoding::kGray ? value ^ (value >> 1) : value;
}

// Returns the csp set point in u: the nearest position that the wrapping counter can denote.
double SetPosition(const ServoEncoder& encoder, const ServoState& s, double position_counts) noexcept {
  const double here = EncoderPosition(encoder, s);
  const int bits = encoder.type == ServoEncoderType::kIncremental ? 32 : encoder.ssi_bits;
  const auto range = static_cast<double>(std::uint64_t{1} << bits);
  const double away =
      FiniteOrZero(position_counts - static_cast<double>(s.counter_origin) - here * CountsPerUnit(encoder));
  return here + (std::abs(away) < range / 2 ? away : std::remainder(away, range)) / CountsPerUnit(encoder);
}

double SetVelocity(const ServoParams& p, const ServoOutputs& commanded, double sense) noexcept {
  if (commanded.mode != DriveMode::kAnalog) {
    return sense * FiniteOrZero(commanded.velocity_counts_s) / CountsPerUnit(p.encoder);
  }
  const ServoDrive& d = p.drive;
  const double seen_mv = FiniteOrZero(commanded.voltage_v) * 1000 + d.offset_mv;
  const double acting_mv = std::max(seen_mv - d.dead_band_plus_mv, 0.0) + std::min(seen_mv + d.dead_band_minus_mv, 0.0);
  return sense * acting_mv / 10000 * d.velocity_at_10v;
}

// Ready once enabled for the power-up time, with a tolerance of half a cycle for the sum of the periods.
bool PowerOn(const ServoDrive& drive, bool enable, double period_s, ServoState& s) noexcept {
  if (!enable || s.faults.drive_fault) {
    s.enabled_s = 0;
    s.following = false;
    s.compensation = 0;
    return false;
  }
  const bool ready = s.enabled_s > drive.power_up_s - period_s / 2;
  if (!ready) s.enabled_s += period_s;
  return ready;
}

// Returns the displacement of the load relative to the motor by the screw error.
double ScrewError(const ServoMechanics& mechanics, double position) noexcept {
  const std::vector<ServoScrewPoint>& screw = mechanics.screw;
  if (screw.empty()) return 0;
  if (position <= screw.front().position) return screw.front().error;
  for (std::size_t i = 1; i < screw.size(); ++i) {
    if (position > screw[i].position) continue;
    const ServoScrewPoint& low = screw[i - 1];
    return low.error + (screw[i].error - low.error) * (position - low.position) / (screw[i].position - low.position);
  }
  return screw.back().error;
}

// The mechanics between motor and load: the load follows at the ends of the backlash, and not beyond the stops, which
// absorb the velocity. Returns true if a stop was hit.
bool MoveLoad(const ServoMechanics& mechanics, Motion& m) noexcept {
  const double play = mechanics.backlash / 2;
  bool hit = false;
  if (mechanics.upper_stop && m.position > *mechanics.upper_stop + play) {
    m.position = *mechanics.upper_stop + play;
    hit = m.velocity > 0;
  } else if (mechanics.lower_stop && m.position < *mechanics.lower_stop - play) {
    m.position = *mechanics.lower_stop - play;
    hit = m.velocity < 0;
  }
  if (hit) m.velocity = 0;
  const double driven = m.position + ScrewError(mechanics, m.position);
  m.load = std::clamp(m.load, driven - play, driven + play);
  return hit;
}

bool Reads(const ServoSwitch& sw, double position, double revolution) noexcept {
  bool on = sw.from || sw.to;
  if (sw.from && sw.to && revolution > 0) {
    const double past = position - *sw.from;
    on = past - revolution * std::floor(past / revolution) <= *sw.to - *sw.from;
  } else {
    on = on && (!sw.from || position >= *sw.from) && (!sw.to || position <= *sw.to);
  }
  return on != sw.normally_closed;
}

// Updates the touch probe's signal over one step of the drive that ended `rest` before the end of the cycle. If it
// changed, the instant is found by bisection of the exact motion.
[[gnu::noinline]] void WatchProbe(const ServoParams& p, const Law& law, const Motion& begin, double time, double rest,
                                  const Motion& end, ServoState& s) noexcept {
  const ServoSwitch& probe = p.switches.touch_probe;
  const auto reads = [&](const Motion& m) { return Reads(probe, m.load, p.switches.revolution); };
  const bool on = reads(end);
  if (on == s.probe) return;
  s.probe = on;
  double before = 0;
  double after = time;
  for (int i = 0; i < kProbeBisections; ++i) {
    const double middle = 0.5 * (before + after);
    Motion m = begin;
    Advance(law, middle, ReachAfter(law.viscous + law.gain, middle), m);
    MoveLoad(p.mechanics, m);
    (reads(m) == on ? after : before) = middle;
  }
  ++(on ? s.probe_rises : s.probe_falls);
  (on ? s.probe_rise_age_s : s.probe_fall_age_s) = rest + time - after;
}

// The law of a torque set point: that torque, limited by a velocity loop at `until`. While `until` still has the
// opposite sign, the axis is reversing, and friction may stop it earlier: nothing acts against the torque. Beyond the
// largest velocity in either direction, the drive brakes with full torque.
void FollowTorque(double most, double set_torque, double largest_speed, double until, double v, Law& law) noexcept {
  const double sense = set_torque >= 0 ? 1 : -1;
  const bool overhauled = sense * v < -largest_speed;
  const bool overrun = sense * v > largest_speed;
  const double against = overhauled || (sense * until < 0 && !overrun) ? 0 : most;
  const double along = overhauled ? most : std::abs(set_torque);
  law.target = overhauled ? -sense * largest_speed : overrun ? sense * largest_speed : until;
  law.low = sense > 0 ? -against : -along;
  law.high = sense > 0 ? along : against;
}

void Move(const ServoParams& p, const ServoOutputs& commanded, double period_s, bool powered, ServoState& s) noexcept {
  const ServoDrive& drive = p.drive;
  const ServoMechanics& mechanics = p.mechanics;
  const double sense = drive.inverted ? -1 : 1;
  const double per_inertia = 1 / mechanics.inertia;
  const bool csp = powered && commanded.mode == DriveMode::kCyclicPosition;
  const bool cst = powered && commanded.mode == DriveMode::kCyclicTorque;
  const bool compensates = powered && drive.load_compensation_s > 0;

  Law law;
  law.viscous = mechanics.viscous_friction * per_inertia;
  law.friction = (mechanics.coulomb_friction + (commanded.release_brake ? 0 : mechanics.brake_torque)) * per_inertia;
  law.load = (mechanics.load_torque + s.faults.extra_load) * per_inertia;
  if (powered) {
    law.lag = drive.velocity_time_constant_s;
    law.gain = 1 / law.lag;
    const double limit = FiniteOrZero(commanded.torque_limit_nm);
    law.high = (limit > 0 ? std::min(limit, drive.max_torque) : drive.max_torque) * per_inertia;
    law.low = -law.high;
    law.target = SetVelocity(p, commanded, sense);
  }

  const double end_velocity = law.target;
  const double end_position = csp ? SetPosition(p.encoder, s, sense * commanded.position_counts) : 0;
  const double start_velocity = s.following ? s.set_velocity : end_velocity;
  const double start_position = s.following ? s.set_position : end_position;
  s.following = csp;
  s.set_position = end_position;
  s.set_velocity = end_velocity;

  // The motion itself is exact over any time; steps are only needed where the drive's own loops are sampled.
  const int steps = csp || cst || compensates ? std::max(1, static_cast<int>(period_s / drive.loop_period_s + 0.5)) : 1;
  const double time = period_s / steps;
  const double rate = law.viscous + law.gain;
  if (s.reach_rate != rate || s.reach_time != time) {
    const Reach reach = ReachAfter(rate, time);
    s.reach_rate = rate;
    s.reach_time = time;
    s.reach_to_velocity = reach.to_velocity;
    s.reach_to_distance = reach.to_distance;
  }
  const double most = law.high;
  const double set_torque = cst ? std::clamp(sense * FiniteOrZero(commanded.torque_nm) * per_inertia, -most, most) : 0;
  const double largest_speed = std::abs(law.target);
  const double until = std::clamp(sense * FiniteOrZero(commanded.torque_until_counts_s) / CountsPerUnit(p.encoder),
                                  -largest_speed, largest_speed);
  const Reach whole{s.reach_to_velocity, s.reach_to_distance};
  const Reach model = law.viscous > 0 ? ReachAfter(law.gain, time) : whole;
  const double learning = compensates ? time / ((drive.load_compensation_s + time) * model.to_velocity) : 0;

  const bool motor_encoder = p.encoder.place == ServoEncoderPlace::kMotor;
  const bool probe_wired = p.switches.touch_probe.from || p.switches.touch_probe.to;
  const double set_step = (end_position - start_position) / steps;
  const double feed_forward_step = (end_velocity - start_velocity) / steps;
  const double offset = csp || (powered && commanded.mode == DriveMode::kCyclicVelocity)
                            ? sense * FiniteOrZero(commanded.torque_nm) * per_inertia
                            : 0;
  law.bias = s.compensation + offset;
  Motion motion{s.motor_position, s.faults.stuck ? 0 : s.velocity, s.load_position};
  for (int i = 0; i < steps; ++i) {
    if (csp) {
      // The error is that at the begin of the step, the velocity fed forward that at its middle.
      const double set = start_position + set_step * i;
      const double feed_forward = start_velocity + feed_forward_step * (i + 0.5);
      const double error = set - (motor_encoder ? motion.position : motion.load);
      law.target = drive.position_gain * error + drive.velocity_feed_forward * feed_forward;
    }
    if (cst) FollowTorque(most, set_torque, largest_speed, until, motion.velocity, law);
    const Motion begin = motion;
    bool hit = false;
    if (!s.faults.stuck) {
      Advance(law, time, whole, motion);
      hit = MoveLoad(mechanics, motion);
    }
    if (probe_wired) WatchProbe(p, law, begin, time, time * (steps - 1 - i), motion, s);
    // The deviation of the velocity from the bare first-order model is load, which the drive learns to compensate; not
    // while the torque is at its limit or the axis hits a stop, where the model does not apply.
    const double lag = law.target - begin.velocity;
    const double asked = law.gain * lag + law.bias;
    if (compensates && !hit && asked >= law.low && asked <= law.high) {
      // With an offset the axis accelerates as commanded, without lag: that is no load to be learnt.
      const double set_change = csp && offset != 0 ? feed_forward_step : 0;
      const double expected = begin.velocity + lag * (law.gain * model.to_velocity) + set_change;
      law.bias = std::clamp(law.bias + learning * (expected - motion.velocity), -most, most);
    }
  }
  s.motor_position = motion.position;
  s.velocity = motion.velocity;
  s.load_position = motion.load;
  s.compensation = law.bias - offset;
  s.torque = law.DriveAt(s.velocity) * mechanics.inertia;
  if (cst) {  // the position loop will take over from the position of the axis
    s.following = true;
    s.set_position = EncoderPosition(p.encoder, s);
    s.set_velocity = s.velocity;
  }
}

// SplitMix64: a counter whose bits are mixed.
double Uniform(std::uint64_t& state) noexcept {
  state += 0x9E3779B97F4A7C15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  z ^= z >> 31;
  return (static_cast<double>(z >> 11) + 0.5) * 0x1p-53;
}

double Normal(std::uint64_t& state) noexcept {
  const double radius = std::sqrt(-2 * maths::Log(Uniform(state)));
  return radius * maths::Cos(2 * std::numbers::pi * Uniform(state));
}

// Distance-coded marks: returns the distance of the coded mark from the fixed one of this pair.
double CodedMark(const ServoEncoder& encoder, std::int64_t pair) noexcept {
  return encoder.index_distance / 2 + static_cast<double>(pair + 1) * encoder.index_step;
}

// The number of pairs is the number of codes.
std::int64_t CodedPairs(const ServoEncoder& encoder) noexcept {
  return -Floor(-encoder.index_distance / (2 * encoder.index_step)) - 1;
}

// Returns the number of the last mark below the position, in the sense of the scale.
std::int64_t IndexCell(const ServoEncoder& encoder, double position) noexcept {
  if (encoder.index_distance <= 0) return 0;
  const double way = encoder.index_reversed ? encoder.index_offset - position : position - encoder.index_offset;
  const std::int64_t pair = Floor(way / encoder.index_distance);
  if (encoder.index_step == 0) return pair;
  const std::int64_t pairs = CodedPairs(encoder);
  if (pair < 0) return -1;
  if (pair >= pairs) return 2 * pairs - 1;
  const double within = way - static_cast<double>(pair) * encoder.index_distance;
  return 2 * pair + (within >= CodedMark(encoder, pair) ? 1 : 0);
}

double IndexMark(const ServoEncoder& encoder, std::int64_t mark) noexcept {
  const bool coded = encoder.index_step > 0;
  const std::int64_t pair = coded ? mark / 2 : mark;
  const double behind = coded && mark % 2 != 0 ? CodedMark(encoder, pair) : 0;
  const double way = static_cast<double>(pair) * encoder.index_distance + behind;
  return encoder.index_offset + (encoder.index_reversed ? -way : way);
}

void ReadEncoder(const ServoEncoder& encoder, ServoState& s) noexcept {
  const double position = EncoderPosition(encoder, s);
  const std::int64_t cell = IndexCell(encoder, position);
  const double noise = encoder.noise_counts > 0 ? encoder.noise_counts * Normal(s.noise) : 0;
  if (!s.faults.encoder_frozen) {
    s.counts = OnTheWire(encoder, CounterAt(encoder, s.counter_origin, position, noise));
    if (cell != s.index_cell) {
      const std::int64_t passed = cell > s.index_cell ? cell : cell + 1;  // the last one passed
      const double at = IndexMark(encoder, passed);
      s.index_counts = OnTheWire(encoder, CounterAt(encoder, s.counter_origin, at, 0));
      s.index_pulses += static_cast<std::uint32_t>(std::abs(cell - s.index_cell));
    }
  }
  s.index_cell = cell;
}

void ReadLoadEncoder(const ServoEncoder& encoder, ServoState& s) noexcept {
  if (s.faults.encoder_frozen) return;
  const double noise = encoder.noise_counts > 0 ? encoder.noise_counts * Normal(s.noise) : 0;
  s.load_counts = OnTheWire(encoder, CounterAt(encoder, s.load_counter_origin, s.load_position, noise));
}

// Returns the value of the counter at position 0: an incremental one starts with its offset at any position.
std::int64_t CounterOrigin(const ServoEncoder& encoder, double start) noexcept {
  const bool incremental = encoder.type == ServoEncoderType::kIncremental;
  return encoder.offset_counts - (incremental ? Nearest(start * CountsPerUnit(encoder)) : 0);
}

void Report(const ServoParams& p, const ServoState& s, bool powered, ServoInputs& measured) noexcept {
  measured.counts = s.counts;
  measured.index_counts = s.index_counts;
  measured.index_pulses = s.index_pulses;
  measured.encoder_error = s.faults.encoder_error;
  measured.limit_positive = Reads(p.switches.limit_positive, s.load_position, 0);
  measured.limit_negative = Reads(p.switches.limit_negative, s.load_position, 0);
  measured.reference = Reads(p.switches.reference, s.load_position, p.switches.revolution);
  measured.touch_probe = s.probe;
  measured.probe_rises = s.probe_rises;
  measured.probe_falls = s.probe_falls;
  measured.probe_rise_age_s = s.probe_rise_age_s;
  measured.probe_fall_age_s = s.probe_fall_age_s;
  measured.drive_ready = powered;
  measured.drive_fault = s.faults.drive_fault;
  measured.torque_nm = s.torque;
  measured.load_counts = s.load_counts;
}

}  // namespace

ServoState MakeServoState(const ServoParams& p) noexcept {
  ServoState s;
  s.motor_position = p.mechanics.start_position;
  s.load_position = p.mechanics.start_position + ScrewError(p.mechanics, p.mechanics.start_position);
  s.counter_origin = CounterOrigin(p.encoder, s.motor_position);
  if (p.load_encoder) {
    s.load_counter_origin = CounterOrigin(*p.load_encoder, s.load_position);
    s.load_counts = OnTheWire(*p.load_encoder, CounterAt(*p.load_encoder, s.load_counter_origin, s.load_position, 0));
  }
  s.index_cell = IndexCell(p.encoder, s.motor_position);
  s.noise = static_cast<std::uint64_t>(p.encoder.noise_seed);
  s.counts = OnTheWire(p.encoder, CounterAt(p.encoder, s.counter_origin, s.motor_position, 0));
  s.probe = Reads(p.switches.touch_probe, s.load_position, p.switches.revolution);
  return s;
}

void Step(const ServoParams& p, const ServoOutputs& commanded, double period_s, ServoState& s,
          ServoInputs& measured) noexcept {
  const bool powered = PowerOn(p.drive, commanded.enable, period_s, s);
  Move(p, commanded, period_s, powered, s);
  ReadEncoder(p.encoder, s);
  if (p.load_encoder) ReadLoadEncoder(*p.load_encoder, s);
  Report(p, s, powered, measured);
}

MovedServo MakeMovedServo(const ServoParams& p) noexcept {
  MovedServo m;
  m.servo = MakeServoState(p);
  return m;
}

void BeginCycle(const ServoParams& p, const ServoOutputs& commanded, double period_s, int steps,
                MovedServo& m) noexcept {
  ServoState& s = m.servo;
  const double sense = p.drive.inverted ? -1 : 1;
  m.powered = PowerOn(p.drive, commanded.enable, period_s, s);
  m.commanded = commanded;
  m.steps = steps;
  m.time = period_s / steps;
  const bool csp = m.powered && commanded.mode == DriveMode::kCyclicPosition;
  m.end_velocity = m.powered ? SetVelocity(p, commanded, sense) : 0;
  m.end_position = csp ? SetPosition(p.encoder, s, sense * commanded.position_counts) : 0;
  m.start_velocity = s.following ? s.set_velocity : m.end_velocity;
  m.start_position = s.following ? s.set_position : m.end_position;
  s.following = csp;
  s.set_position = m.end_position;
  s.set_velocity = m.end_velocity;
  if (!m.powered) m.expects = false;
  if (commanded.release_brake) m.braked = false;
}

double AskTorque(const ServoParams& p, int i, double position, double velocity, double feed_forward,
                 MovedServo& m) noexcept {
  ServoState& s = m.servo;
  const ServoDrive& drive = p.drive;
  const double inertia = p.mechanics.inertia;
  const double motor_limit = drive.max_torque / inertia;
  s.motor_position = position;
  s.load_position = position;
  s.velocity = velocity;
  if (const bool on = Reads(p.switches.touch_probe, position, p.switches.revolution); on != s.probe) {
    s.probe = on;
    ++(on ? s.probe_rises : s.probe_falls);
    (on ? s.probe_rise_age_s : s.probe_fall_age_s) = m.time * (m.steps - i);
  }

  double asked = 0;
  m.limited = false;
  const bool offers = m.commanded.mode == DriveMode::kCyclicPosition || m.commanded.mode == DriveMode::kCyclicVelocity;
  const double offset = offers ? (drive.inverted ? -1 : 1) * FiniteOrZero(m.commanded.torque_nm) : 0;
  if (m.powered) {
    const double limit = FiniteOrZero(m.commanded.torque_limit_nm);
    const double most = limit > 0 ? std::min(limit / inertia, motor_limit) : motor_limit;
    Law law;
    law.lag = drive.velocity_time_constant_s;
    law.low = -most;
    law.high = most;
    law.target = m.end_velocity;
    const double sense = drive.inverted ? -1 : 1;
    if (m.commanded.mode == DriveMode::kCyclicPosition) {
      const double share = static_cast<double>(i) / m.steps;
      const double set = m.start_position + (m.end_position - m.start_position) * share;
      const double ahead = m.start_velocity + (m.end_velocity - m.start_velocity) * (share + 0.5 / m.steps);
      law.target = drive.position_gain * (set - position) + drive.velocity_feed_forward * ahead;
    }
    if (m.commanded.mode == DriveMode::kCyclicTorque) {
      const double largest = std::abs(law.target);
      const double until = std::clamp(
          sense * FiniteOrZero(m.commanded.torque_until_counts_s) / CountsPerUnit(p.encoder), -largest, largest);
      const double set = std::clamp(sense * FiniteOrZero(m.commanded.torque_nm) / inertia, -most, most);
      FollowTorque(most, set, largest, until, velocity, law);
    }
    // The deviation of the velocity from the first-order model is load, which the drive learns to compensate, as in
    // Move.
    if (m.expects && drive.load_compensation_s > 0) {
      const double learning = (m.expected_velocity - velocity) / (drive.load_compensation_s + m.time);
      s.compensation = std::clamp(s.compensation + learning, -most, most);
    }
    // The discrete gain that has the effect of the continuous law over a step: stable for any time constant.
    const double share = 1 - maths::Exp(-m.time / law.lag);
    const double free = share / m.time * (law.target - velocity) + s.compensation + (feed_forward + offset) / inertia;
    asked = std::clamp(free, law.low, law.high);
    m.limited = std::abs(free) > most;
    m.expects = asked == free;
    m.expected_velocity = velocity + share * (law.target - velocity);
    // With an offset the axis accelerates as commanded, without lag: that is no load to be learnt.
    if (offset != 0 && m.commanded.mode == DriveMode::kCyclicPosition) {
      m.expected_velocity += (m.end_velocity - m.start_velocity) / m.steps;
    }
    // the position loop will take over from the position of the axis
    if (m.commanded.mode == DriveMode::kCyclicTorque) {
      s.following = true;
      s.set_position = position;
      s.set_velocity = velocity;
    }
  }
  s.torque = asked * inertia;

  // An applied brake holds its position like a stiff damped spring, up to its torque; beyond it, it slips.
  m.brake = 0;
  if (!m.commanded.release_brake && p.mechanics.brake_torque > 0) {
    if (!m.braked) m.brake_position = position;
    m.braked = true;
    const double stiffness = 0.3 / m.time;  // [1/s]
    const double wanted = stiffness * (stiffness * (m.brake_position - position) - 2 * velocity) * inertia;
    m.brake = std::clamp(wanted, -p.mechanics.brake_torque, p.mechanics.brake_torque);
    if (m.brake != wanted) m.brake_position = position;
  }
  return s.torque + m.brake;
}

void Sense(const ServoParams& p, double position, double velocity, MovedServo& m, ServoInputs& measured) noexcept {
  ServoState& s = m.servo;
  s.motor_position = position;
  s.load_position = position;
  s.velocity = velocity;
  ReadEncoder(p.encoder, s);
  if (p.load_encoder) ReadLoadEncoder(*p.load_encoder, s);
  Report(p, s, m.powered, measured);
}

}  // namespace takt::plant
