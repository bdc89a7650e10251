#include "takt/planar/right_of_way.h"

namespace takt::planar {
namespace {

// [mm] accuracy of a position that is to be exactly at the gap.
constexpr double kJustThere = 1e-6;
// Largest number of passages near which a mover can be in one cycle: at the nodes of its route, its start, the tracks
// passed, and beyond; at the beginning of the cycle and after its step.
constexpr std::size_t kPresences = 2 * (kRouteTracks + 1 + kPassed + 2 * kBeyond);

// Returns true if the mover reverses before it rests.
bool TurnsRound(const Braking& b) {
  const double start = b.pieces[0].position;
  const bool up = b.lowest == start && b.highest == b.rest, down = b.highest == start && b.lowest == b.rest;
  return b.lowest < b.highest && !up && !down;
}

// Returns the distance to keep: if it is less already, it must not decrease.
double Required(double gap, double apart_now) {
  return std::min(gap - kTolerance, apart_now);
}

bool Holds(const Braking& of_behind, const Braking& of_ahead, double apart, double required) {
  // In most cases the extremes suffice.
  if (of_ahead.lowest + apart - of_behind.highest >= required) return true;
  return LeastDistance(of_behind, of_ahead, apart) >= required;
}

}  // namespace

Scene::Scene(std::uint32_t movers, std::uint32_t tracks)
    : now(movers),
      order(movers),
      begins(tracks + 1),
      index(movers),
      heads(2 * tracks),
      presences(movers * kPresences),
      stack(movers) {}

void RightOfWay::Begin() noexcept {
  s_.presence_count = 0;
  s_.off = 0;
  for (const Rider& r : riders_) s_.off = std::max(s_.off, r.on ? r.off : 0.0);
  std::ranges::fill(s_.heads, kNobody);
  for (std::uint32_t i = 0; i < riders_.size(); ++i) TakeToBrake(i);
  Sort();
  for (std::uint32_t i = 0; i < riders_.size(); ++i) {
    if (!riders_[i].on) continue;
    s_.now[i].leader = FindLeader(i, riders_[i].direction, s_.now[i].leader_offset);
    EnterNodes(i, s_.now[i].next, s_.now[i].braking);
  }
}

void RightOfWay::TakeToBrake(std::uint32_t i) noexcept {
  const Rider& r = riders_[i];
  Now& now = s_.now[i];
  now = {};
  if (!r.on) return;
  if (Rests(r.at)) {
    now.next = r.at;
    now.braking.rest = now.braking.lowest = now.braking.highest = now.rest_before = r.at.position;
    now.hard = now.braking;
    return;
  }
  const Brakes brakes = BrakesOf(r);
  const Braking braking = Brake(r.at, brakes);
  now.next = braking.At(period_s_);
  now.share = r.share;
  now.hard = now.braking = Brake(now.next, brakes);
  now.rest_before = braking.rest;
  if (r.share == 0) return;
  now.hard = Brake(now.next, r.brakes);
  now.rest_before = Brake(r.at, r.brakes).rest;
}

void RightOfWay::Sort() noexcept {
  std::ranges::fill(s_.begins, 0U);
  for (const Rider& r : riders_) {
    if (r.on) ++s_.begins[r.route.first() + 1];
  }
  for (std::size_t i = 1; i < s_.begins.size(); ++i) s_.begins[i] += s_.begins[i - 1];
  // Filling advances the begins, which are restored afterwards.
  for (std::uint32_t i = 0; i < riders_.size(); ++i) {
    if (riders_[i].on) s_.order[s_.begins[riders_[i].route.first()]++] = i;
  }
  for (std::size_t i = s_.begins.size() - 1; i > 0; --i) s_.begins[i] = s_.begins[i - 1];
  s_.begins[0] = 0;
  for (std::size_t track = 0; track + 1 < s_.begins.size(); ++track) {
    const auto first = s_.order.begin() + s_.begins[track], last = s_.order.begin() + s_.begins[track + 1];
    std::sort(first, last, [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = riders_[a].at.position, at_b = riders_[b].at.position;
      return at_a < at_b || (at_a == at_b && a < b);
    });
    for (auto k = first; k != last; ++k) s_.index[*k] = static_cast<std::uint32_t>(k - s_.order.begin());
  }
}

std::uint32_t RightOfWay::FindLeader(std::uint32_t i, int direction, double& offset) const noexcept {
  const Rider& r = riders_[i];
  const std::uint32_t track = r.route.first();
  const std::uint32_t first = s_.begins[track], last = s_.begins[track + 1], index = s_.index[i];
  offset = 0;
  if (direction > 0 && index + 1 < last) return s_.order[index + 1];
  if (direction < 0 && index > first) return s_.order[index - 1];
  if (network_[track].closed) {
    const std::uint32_t round = s_.order[direction > 0 ? first : last - 1];
    offset = direction > 0 ? network_[track].length : -network_[track].length;
    return round == i ? kNobody : round;
  }
  if (direction < 0) return kNobody;
  const double gap = r.gap + r.off + s_.off;
  const double reach = s_.now[i].braking.highest + gap + 2 * StoppingDistance(r.pace.limits.velocity, r.pace.brakes());
  for (std::uint32_t k = 1; k < r.route.count; ++k) {
    offset += network_[r.route.tracks[k - 1]].length;
    if (offset > reach) break;
    const std::uint32_t next = r.route.tracks[k];
    if (s_.begins[next] == s_.begins[next + 1]) continue;
    const std::uint32_t found = s_.order[s_.begins[next]];
    return found == i ? kNobody : found;
  }
  return kNobody;
}

bool RightOfWay::HoldsAhead(const Braking& of_behind, std::uint32_t ahead, double apart,
                            double required) const noexcept {
  const Now& its = s_.now[ahead];
  return Holds(of_behind, its.braking, apart, required) &&
         (its.share == 0 || Holds(of_behind, its.hard, apart, required));
}

bool RightOfWay::HoldsBehind(std::uint32_t behind, const Braking& of_ahead, double apart,
                             double required) const noexcept {
  const Now& its = s_.now[behind];
  return Holds(its.braking, of_ahead, apart, required) &&
         (its.share == 0 || Holds(its.hard, of_ahead, apart, required));
}

bool RightOfWay::Keeps(const Braking& own, const Meeting& m, double required) const noexcept {
  return m.ahead ? HoldsAhead(own, m.other, m.apart, required) : HoldsBehind(m.other, own, -m.apart, required);
}

// Enters a mover at all nodes where it may be active together with another one.
void RightOfWay::EnterNodes(std::uint32_t i, const KinematicState& next, const Braking& braking) noexcept {
  const Rider& r = riders_[i];
  const double zone = std::max(r.zone, r.gap), off = r.off + s_.off;
  AlongNodes(r, braking.highest + zone + off, [&](const Passage& p) {
    if (!IsActive(zone, off, next, braking, p)) return;
    for (std::uint32_t k = s_.heads[p.node]; k != kNobody; k = s_.presences[k].next) {
      if (s_.presences[k].mover == i && s_.presences[k].passage == p) return;
    }
    s_.presences[s_.presence_count] = {i, p, s_.heads[p.node], r.at.position - p.offset, r.off};
    s_.heads[p.node] = s_.presence_count++;
  });
}

bool RightOfWay::IsOnRoute(const Rider& r, const Rider& other, double apart) const noexcept {
  double begin = 0;
  for (const std::uint32_t track : r.route.all()) {
    if (begin > apart + kSame) return false;
    if (track == other.route.first() && begin >= apart - kSame) return true;
    begin += network_[track].length;
  }
  return false;
}

double RightOfWay::GapTo(std::uint32_t i, std::uint32_t leader, int direction) const noexcept {
  const Rider &r = riders_[i], &other = riders_[leader];
  const bool faces = other.at.velocity * direction < 0;
  return (faces ? std::max(r.gap, other.gap) : r.gap) + r.off + other.off;
}

bool RightOfWay::MayTake(std::uint32_t i, const KinematicState& next, const Braking& braking) const noexcept {
  const Rider& r = riders_[i];
  const Now& now = s_.now[i];
  // A mover that reverses moves both ways.
  const bool turns = TurnsRound(braking) || TurnsRound(now.braking);
  const bool forward = turns || braking.highest > now.braking.highest || next.position > now.next.position;
  const bool back = turns || braking.lowest < now.braking.lowest || next.position < now.next.position;
  const bool closed = network_[r.route.first()].closed;
  if (back && !closed && std::min(braking.lowest, next.position) < std::min(0.0, now.braking.lowest) - kTolerance) {
    return false;
  }
  if (forward && !closed) {
    double end = now.braking.highest;
    const auto beyond = [&] { return braking.highest > end + kTolerance; };
    double length = 0;
    for (std::uint32_t k = 0; k < r.route.count && beyond(); ++k) {
      length += network_[r.route.tracks[k]].length;
      end = std::max(end, length);
    }
    if (beyond()) return false;
  }
  if (forward) {
    double apart = now.leader_offset;
    const std::uint32_t leader = r.direction > 0 ? now.leader : FindLeader(i, 1, apart);
    if (leader != kNobody) {
      const double required = Required(GapTo(i, leader, 1), riders_[leader].at.position + apart - r.at.position);
      if (!HoldsAhead(braking, leader, apart, required)) return false;
    }
  }
  if (back) {
    double apart = now.leader_offset;
    const std::uint32_t leader = r.direction < 0 ? now.leader : FindLeader(i, -1, apart);
    if (leader != kNobody) {
      const double required = Required(GapTo(i, leader, -1), r.at.position - riders_[leader].at.position - apart);
      if (!HoldsBehind(leader, braking, -apart, required)) return false;
    }
    bool may = true;
    Followers(i, [&](std::uint32_t k, double offset) {
      const Rider& other = riders_[k];
      const double gap = std::max(other.gap, r.gap) + other.off + r.off;
      const double required = Required(gap, r.at.position + offset - other.at.position);
      may = may && HoldsBehind(k, braking, offset, required);
    });
    if (!may) return false;
  }
  bool may = true;
  const double off = r.off + s_.off;
  AlongNodes(r, braking.highest + std::max(r.zone, r.gap) + off, [&](const Passage& p) {
    if (!may || !IsActive(r.zone, off, next, braking, p)) return;
    bool anew = false;
    const auto counts = [&](const Meeting& m) {
      if (!may || !IsActive(r.zone, m.off, next, braking, p)) return false;
      anew = !IsActive(r.zone, m.off, now.next, now.braking, p);
      return (anew || (m.ahead ? forward : back)) && IsActive(m);
    };
    MeetAt(i, p, counts, [&](const Meeting& m) {
      // Movers that were not active were kept apart by other means, and need the full distance from now on.
      double required = anew ? m.gap - kTolerance : Required(m.gap, std::abs(m.place));
      const double furthest = m.ahead ? braking.highest : s_.now[m.other].braking.highest + m.apart;
      if (furthest > p.offset + kTolerance) required = std::max(required, m.split - kTolerance);
      may = Keeps(braking, m, required);
    });
  });
  return may;
}

bool RightOfWay::MayWiden(std::uint32_t i, double zone) const noexcept {
  const Rider& r = riders_[i];
  const Now& now = s_.now[i];
  bool may = true;
  AlongNodes(r, now.braking.highest + zone + r.off + s_.off, [&](const Passage& p) {
    const auto counts = [&](const Meeting& m) {
      return may && IsActive(zone, m.off, now.next, now.braking, p) &&
             !IsActive(r.zone, m.off, now.next, now.braking, p) && IsActive(m);
    };
    MeetAt(i, p, counts, [&](const Meeting& m) {
      const double furthest = m.ahead ? now.braking.highest : s_.now[m.other].braking.highest + m.apart;
      may = Keeps(now.braking, m, (furthest > p.offset + kTolerance ? std::max(m.gap, m.split) : m.gap) - kTolerance);
    });
  });
  return may;
}

std::uint32_t RightOfWay::TooNear(std::uint32_t i) const noexcept {
  const Rider& r = riders_[i];
  const Now& now = s_.now[i];
  std::uint32_t who = kNobody;
  // `apart`: own position minus the other's of the same point.
  const auto look = [&](std::uint32_t other, double apart, bool ahead, double gap) {
    const Braking& own = now.braking;
    const double required = gap - kJustThere;
    if (!(ahead ? HoldsAhead(own, other, apart, required) : HoldsBehind(other, own, -apart, required))) who = other;
  };
  const auto gap = [&](std::uint32_t other) {
    const Rider& o = riders_[other];
    return std::max(r.gap, o.gap) + r.off + o.off;
  };
  for (const int direction : {1, -1}) {
    double apart = 0;
    const std::uint32_t next = FindLeader(i, direction, apart);
    if (next != kNobody) look(next, apart, direction > 0, gap(next));
  }
  for (std::uint32_t k = 0; k < riders_.size(); ++k) {
    double offset = 0;
    if (!riders_[k].on || k == i || FindLeader(k, 1, offset) != i) continue;
    look(k, -offset, false, gap(k));
  }
  AlongNodes(r, now.braking.highest + std::max(r.zone, r.gap) + r.off + s_.off, [&](const Passage& p) {
    const auto counts = [&](const Meeting& m) {
      return IsActive(r.zone, m.off, now.next, now.braking, p) && IsActive(m);
    };
    MeetAt(i, p, counts, [&](const Meeting& m) {
      const double furthest = m.ahead ? now.braking.highest : s_.now[m.other].braking.highest + m.apart;
      look(m.other, m.apart, m.ahead, furthest > p.offset + kTolerance ? std::max(m.gap, m.split) : m.gap);
    });
  });
  return who;
}

void RightOfWay::Take(std::uint32_t i, const KinematicState& next, const Braking& braking, std::size_t share) noexcept {
  Now& now = s_.now[i];
  now.next = next;
  now.braking = braking;
  now.share = static_cast<std::uint8_t>(share);
  now.hard = share == 0 ? braking : Brake(next, riders_[i].brakes);
  now.taken = true;
  EnterNodes(i, next, braking);
}

}  // namespace takt::planar
