#include "takt/routing/sipp.h"

#include <algorithm>
#include <queue>
#include <tuple>

namespace takt::routing {
namespace {

constexpr double kNext = 1e-6;  // [s] after the end of an interval

}  // namespace

double Sipp::Departure(const Timetable& timetable, CellIndex place, Direction lane, int count, double from,
                       double latest) const {
  constexpr int kMostRounds = 1000;
  const int along = grid_.Along(lane, place);
  const CellIndex step = grid_.Step(lane);
  const double duration = grid_.Duration(count);
  double at = from;
  for (int round = 0; round < kMostRounds; ++round) {
    const double before = at;
    for (int k = 0; k <= count; ++k) {
      const CellIndex here = place + k * step;
      const std::vector<Stay>& stays = timetable.stays(here);
      const double entry = k == 0 ? 0 : grid_.Entry(count, k), exit = k == count ? duration : grid_.Exit(count, k);
      for (std::size_t i = timetable.FirstEndingAfter(here, at + entry);
           i < stays.size() && stays[i].from < at + exit - kTimeRounding; ++i) {
        const Stay& stay = stays[i];
        double later = kForever;
        if (stay.lane == lane) {
          const double behind = at - stay.departure, lag = grid_.Lag(stay.count, count, stay.along - along);
          if (behind >= lag - kTimeRounding) continue;
          if (-behind >= grid_.Lag(count, stay.count, along - stay.along) - kTimeRounding) continue;
          later = stay.departure + lag;
        } else if (k > 0) {
          later = stay.to - entry;
        }
        if (later > latest + kTimeRounding) return kForever;
        at = std::max(at, later);
      }
      if (k < count) continue;
      // The mover rests there from its arrival on.
      for (std::size_t i = timetable.FirstEndingAfter(here, at + duration);
           i < stays.size() && stays[i].from <= at + duration + kTimeRounding; ++i) {
        if (stays[i].to == kForever) return kForever;
        at = std::max(at, stays[i].to - duration);
      }
    }
    if (at > latest + kTimeRounding) return kForever;
    if (at <= before + kTimeRounding) return at;
  }
  return kForever;
}

bool Sipp::Better(CellIndex place, double free_until, double time) {
  std::vector<Earliest>& known = earliest_[static_cast<std::size_t>(place)];
  for (Earliest& one : known) {
    if (one.free_until != free_until) continue;
    if (one.time <= time + kTimeRounding) return false;
    one.time = time;
    return true;
  }
  if (known.empty()) touched_.push_back(place);
  known.push_back({free_until, time});
  return true;
}

std::optional<Legs> Sipp::Find(const Timetable& timetable, const Query& query) {
  states_.clear();
  for (const CellIndex place : touched_) earliest_[static_cast<std::size_t>(place)].clear();
  touched_.clear();
  const std::vector<double>& alone = *query.alone;
  const auto left = [&](CellIndex place) { return alone[static_cast<std::size_t>(place)]; };
  if (left(query.start) == kForever) return std::nullopt;
  // The mover cannot stay at its target before all others have passed it for the last time.
  const double last_end = timetable.LastEnd(query.target);
  if (last_end == kForever) return std::nullopt;
  using Entry = std::tuple<double, double, std::int32_t>;  // estimate of the arrival, its part still ahead, state
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto push = [&](const State& state) {
    double estimate = state.time + query.weight * left(state.place);
    if (state.place != query.target || state.free_until < kForever) estimate = std::max(estimate, last_end);
    open.emplace(estimate, left(state.place), static_cast<std::int32_t>(states_.size()));
    states_.push_back(state);
  };
  const double free_until = timetable.FreeUntil(query.start, 0);
  Better(query.start, free_until, 0);
  push({.time = 0, .free_until = free_until, .place = query.start});
  for (std::int64_t most = query.most; !open.empty() && most > 0; --most) {
    const std::int32_t index = std::get<2>(open.top());
    open.pop();
    const State state = states_[static_cast<std::size_t>(index)];
    const std::vector<Earliest>& known = earliest_[static_cast<std::size_t>(state.place)];
    if (std::any_of(known.begin(), known.end(),
                    [&](const Earliest& one) { return one.free_until == state.free_until && one.time < state.time; })) {
      continue;
    }
    if (state.place == query.target && state.free_until == kForever) {
      Legs legs;
      for (std::int32_t at = index; states_[static_cast<std::size_t>(at)].parent != kNone;
           at = states_[static_cast<std::size_t>(at)].parent) {
        legs.push_back(states_[static_cast<std::size_t>(at)].leg);
      }
      std::reverse(legs.begin(), legs.end());
      return legs;
    }
    ++expanded_;
    for (const Direction lane : kDirections) {
      const int room = grid_.Room(lane, state.place);
      for (int count = 1; count <= room; ++count) {
        const CellIndex to = state.place + count * grid_.Step(lane);
        const double duration = grid_.Duration(count);
        double from = state.time;
        if (from + duration + left(to) >= query.bound) continue;
        // If the place has been reached as early already, only a later interval is of use.
        const std::vector<Earliest>& there = earliest_[static_cast<std::size_t>(to)];
        for (bool again = true; again && from < kForever;) {
          again = false;
          for (const Earliest& one : there) {
            const double arrival = from + duration;
            if (one.time > arrival + kTimeRounding || arrival >= one.free_until - kTimeRounding) continue;
            from = one.free_until - duration;
            again = true;
            break;
          }
        }
        while (from <= state.free_until + kTimeRounding && from < kForever) {
          const double departure = Departure(timetable, state.place, lane, count, from, state.free_until);
          if (departure == kForever) break;
          const double arrival = departure + duration;
          if (arrival + left(to) >= query.bound) break;
          const double until = timetable.FreeUntil(to, arrival);
          if (Better(to, until, arrival)) {
            push({.time = arrival,
                  .free_until = until,
                  .place = to,
                  .parent = index,
                  .leg = {departure, state.place, to}});
          }
          from = std::max(departure, until - duration) + kNext;
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace takt::routing
