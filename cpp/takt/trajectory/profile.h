// A motion known from start to end: pieces of constant jerk.
#pragma once

#include <array>
#include <cstdint>

#include "takt/core/describe_fwd.h"
#include "takt/core/kinematic_state.h"
#include "takt/trajectory/piece.h"

namespace takt::trajectory {

// Pieces of constant jerk from time 0 on. Evaluation is pure: the same time gives the same bits, in any order of calls.
// The members are public to be described, hashed and inspected; only the functions write them.
struct Profile {
  static constexpr int kCapacity = 16;

  // `Profile(start)`: no pieces; stays in `start` forever (at rest, or at constant velocity).
  KinematicState start_state;
  KinematicState end_state = start_state;
  std::int32_t piece_count = 0;
  std::array<double, kCapacity> piece_ends_s{};  // [s] from the start, ascending; 0 from piece_count on
  std::array<Piece, kCapacity> pieces{};         // zero from piece_count on

  // Appends a piece of `duration_s` [s] (ignored unless > 0) with constant jerk [u/s³]. A step of acceleration before
  // it (unlimited jerk) is given as `acceleration`. Returns false, with nothing changed, if there is no room.
  bool Append(double duration_s, double jerk) noexcept {
    return AppendWithAcceleration(duration_s, end_state.acceleration, jerk);
  }
  bool AppendWithAcceleration(double duration_s, double acceleration, double jerk) noexcept;
  // Appends all pieces of `other`. Requires: it starts at the end of this one.
  bool Append(const Profile& other) noexcept;
  // Replaces the computed end by the exact one (they differ by rounding only).
  void SnapEnd(const KinematicState& exact) noexcept { end_state = exact; }

  // Ends the motion at `t` [s], in the state there.
  void Cut(double t) noexcept;

  // Begins the motion at `t` [s] instead, in the state there.
  void Skip(double t) noexcept;

  // Shifts the whole motion by `distance` [u].
  void Shift(double distance) noexcept {
    start_state.position += distance;
    end_state.position += distance;
    for (int i = 0; i < piece_count; ++i) pieces[Index(i)].position += distance;
  }

  // Returns the state at `t` [s]: the start up to 0, the end at duration(), after it the end position moving on at the
  // end velocity with no acceleration. Acceleration is continuous from the right.
  KinematicState At(double t) const noexcept {
    if (t <= 0) return start_state;
    if (t >= duration()) return After(t);
    const Local at = Find(t);
    return at.piece->At(at.t);
  }
  // Returns the jerk of the piece at `t` [s]; 0 before the start and from the end on.
  double JerkAt(double t) const noexcept { return t < 0 || t >= duration() ? 0 : Find(t).piece->jerk; }

  double duration() const noexcept { return piece_count > 0 ? piece_ends_s[Index(piece_count - 1)] : 0; }  // [s]
  const KinematicState& start() const noexcept { return start_state; }
  const KinematicState& end() const noexcept { return end_state; }
  int size() const noexcept { return piece_count; }

  // Returns the time [s] at which the motion is first at `position`, from `begin_s` on until its end; NaN: never.
  double TimeAt(double position, double begin_s = 0) const noexcept;

  // Extreme values over [0, duration()], exact (roots of the pieces' derivatives), not sampled.
  struct Range {
    double min, max;
  };
  Range PositionRange() const noexcept { return PositionRange(0); }
  // From the time `begin_s` [s] on.
  Range PositionRange(double begin_s) const noexcept;
  Range VelocityRange() const noexcept;
  Range AccelerationRange() const noexcept;

 private:
  struct Local {
    const Piece* piece;
    double t;  // [s] from the beginning of the piece
  };
  static constexpr std::size_t Index(int i) noexcept { return static_cast<std::size_t>(i); }
  // 0 <= t < duration(), or NaN (which stays NaN).
  Local Find(double t) const noexcept {
    std::size_t i = 0;
    while (t >= piece_ends_s[i]) ++i;
    return {&pieces[i], i == 0 ? t : t - piece_ends_s[i - 1]};
  }
  double Length(int i) const noexcept { return piece_ends_s[Index(i)] - (i == 0 ? 0 : piece_ends_s[Index(i - 1)]); }
  KinematicState After(double t) const noexcept {
    const double over = t - duration();
    if (over == 0) return end_state;
    return {end_state.position + end_state.velocity * over, end_state.velocity, 0};
  }
};

void describe(Description<Profile>&);

}  // namespace takt::trajectory
