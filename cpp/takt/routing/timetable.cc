#include "takt/routing/timetable.h"

#include <algorithm>

namespace takt::routing {

double Arrival(const Grid& grid, const Legs& legs) {
  if (legs.empty()) return 0;
  const Leg& last = legs.back();
  return last.departure + grid.Duration(grid.Count(last.from, last.to));
}

Timetable::Timetable(const Grid& grid, std::size_t movers)
    : grid_(grid), stays_(static_cast<std::size_t>(grid.size())), places_(movers) {}

void Timetable::Insert(CellIndex place, const Stay& stay) {
  std::vector<Stay>& stays = stays_[static_cast<std::size_t>(place)];
  const auto behind =
      std::upper_bound(stays.begin(), stays.end(), stay, [](const Stay& a, const Stay& b) { return a.from < b.from; });
  stays.insert(behind, stay);
  places_[static_cast<std::size_t>(stay.who)].push_back(place);
}

void Timetable::Rest(CellIndex place, double from, double to, MoverIndex who) {
  Insert(place, {.from = from, .to = to, .who = who});
}

void Timetable::Add(MoverIndex who, CellIndex start, const Legs& legs) {
  if (legs.empty()) Rest(start, -1, kForever, who);
  double since = -1;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Leg& leg = legs[i];
    const Direction lane = grid_.Towards(leg.from, leg.to);
    const int count = grid_.Count(leg.from, leg.to);
    const double end = leg.departure + grid_.Duration(count);
    Stay stay{
        .who = who, .lane = lane, .count = count, .along = grid_.Along(lane, leg.from), .departure = leg.departure};
    if (leg.departure > since) Rest(leg.from, since, leg.departure, who);
    for (int k = 0; k <= count; ++k) {
      stay.from = k == 0 ? leg.departure : leg.departure + grid_.Entry(count, k);
      stay.to = k == count ? end : leg.departure + grid_.Exit(count, k);
      Insert(leg.from + k * grid_.Step(lane), stay);
    }
    if (i + 1 == legs.size()) Rest(leg.to, end, kForever, who);
    since = end;
  }
}

void Timetable::Remove(MoverIndex who) {
  std::vector<CellIndex>& places = places_[static_cast<std::size_t>(who)];
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  for (const CellIndex place : places) {
    std::erase_if(stays_[static_cast<std::size_t>(place)], [who](const Stay& stay) { return stay.who == who; });
  }
  places.clear();
}

double Timetable::LastEnd(CellIndex place) const noexcept {
  return stays(place).empty() ? -1 : stays(place).back().to;
}

}  // namespace takt::routing
