// PL-20, PL-24, PL-60: one cycle of movers on tracks; what it costs to look up a place on a track, to find the nearest
// one, and to make tracks; and to ask whether a mover may go somewhere, beside FCL's tree with the same boxes, which
// answers only where a closer look is needed.

#include <benchmark/benchmark.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>
#include <vector>

#include "cpp/planar/fcl_reference.h"
#include "takt/planar/clearance.h"
#include "takt/planar/nearest.h"
#include "takt/planar/reservation.h"
#include "takt/planar/send.h"
#include "takt/planar/track.h"
#include "takt/planar/traffic.h"

namespace takt::planar {
namespace {

Element Line(const Place& start, const Place& end) {
  return {ElementShape::kLine, start, end};
}

// Round a rectangle, with an arc at one of its corners.
Layout Rectangle() {
  return {.elements = {Line({100, 0}, {900, 0}),
                       Line({1000, 100}, {1000, 900}),
                       {ElementShape::kArc, {960, 920}, {960, 1080}, {960, 1000}, false},
                       Line({900, 1080}, {100, 1080}),
                       Line({0, 980}, {0, 100})},
          .closed = true};
}
// A zigzag of so many lines.
Layout Zigzag(int lines) {
  Layout layout;
  for (int i = 0; i < lines; ++i) {
    const double x = 400.0 * i, y = i % 2 == 0 ? 0 : 200;
    layout.elements.push_back(Line({x, y}, {x + 200, y}));
  }
  return layout;
}

Track Make(const Layout& layout) {
  Track track;
  MakeTrack(layout, track);
  return track;
}

// All pieces, as they come.
void LookUp(benchmark::State& state, bool transitions) {
  const Track track = Make(Zigzag(static_cast<int>(state.range(0))));
  double share = 0;
  std::size_t i = 0;
  for (auto _ : state) {
    share += 0.0123;
    if (share > 1) share -= 1;
    do i = (i + 7) % track.pieces.size();
    while (track.pieces[i].given == transitions);
    benchmark::DoNotOptimize(At(track, track.pieces[i].start + share * track.pieces[i].segment.length));
  }
}

void FindNearest(benchmark::State& state) {
  const Track track = Make(Zigzag(static_cast<int>(state.range(0))));
  double share = 0;
  for (auto _ : state) {
    share += 0.0123;
    if (share > 1) share -= 1;
    benchmark::DoNotOptimize(NearestTo(track, {share * 400 * static_cast<double>(state.range(0)), 150}));
  }
  state.counters["cells"] = static_cast<double>(track.cells.size());
}

void MakeOne(benchmark::State& state) {
  const Layout layout = Rectangle();
  for (auto _ : state) benchmark::DoNotOptimize(Make(layout));
}

void FindConflicts(benchmark::State& state) {
  const TrackPoint start{{0, 0}, 0};
  const Track left = Make({.elements = {Line({100, 100}, {100, 1000})}, .from = start});
  const Track right = Make({.elements = {Line({200, 0}, {1000, 0})}, .from = start});
  const Footprint mover{113, 113};
  for (auto _ : state) benchmark::DoNotOptimize(Conflicts(left, mover, right, mover, 1, 0.1));
}

// Movers on every other stator of a square, half of them on their way to a neighbouring one, and moves to ask for.
struct Crowd {
  struct Wish {
    std::uint32_t mover = 0;
    Move move{};
  };

  Crowd(int count, bool turning) : r(MakeReservations(static_cast<std::size_t>(count), 0)) {
    std::mt19937 random(1);
    const auto between = [&](double lower, double upper) {
      return std::uniform_real_distribution<>(lower, upper)(random);
    };
    const int side = static_cast<int>(std::ceil(std::sqrt(2 * count)));
    std::vector<Place> stators;
    for (int i = 0; i < side * side; ++i) stators.push_back({240.0 * (i % side), 240.0 * (i / side)});
    MakeEnvironment(stators, environment);
    const auto move = [&](std::uint32_t mover, double distance) {
      const Pose& at = r.movers[mover].pose;
      const double direction = between(-3.14, 3.14);
      Move out{
          .target = {{at.place.x + distance * std::cos(direction), at.place.y + distance * std::sin(direction)}, at.c}};
      if (turning) out.target.c += between(-90, 90);
      return out;
    };
    for (int i = 0; i < count; ++i) {
      const auto mover = static_cast<std::uint32_t>(i);
      const int stator = 2 * i + (2 * i / side) % 2;
      Settle(mover, {155, 155}, {{240.0 * (stator % side) + 120, 240.0 * (stator / side) + 120}, 0}, r);
      const Move way = move(mover, 200);
      if (i % 2 == 0 && Ask(mover, way, {.environment = &environment}, r).kind == ObjectKind::kNone)
        Take(mover, way, r);
    }
    for (int i = 0; i < 1000; ++i) {
      const auto mover = static_cast<std::uint32_t>(random() % static_cast<unsigned>(count));
      wishes.push_back({mover, move(mover, between(0, 500))});
    }
  }

  Reservations r;
  Environment environment;
  std::vector<Wish> wishes;
};

void AskFor(benchmark::State& state, bool turning) {
  const Crowd crowd(static_cast<int>(state.range(0)), turning);
  const StaticObstacles around{.environment = &crowd.environment};
  std::size_t i = 0, free = 0, asked = 0;
  std::vector<double> least(crowd.wishes.size(), INFINITY);
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    const ObjectInfo object = Ask(crowd.wishes[i].mover, crowd.wishes[i].move, around, crowd.r);
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    least[i] = std::min(least[i], time.count());
    free += object.kind == ObjectKind::kNone ? 1 : 0;
    ++asked;
    i = (i + 1) % crowd.wishes.size();
  }
  state.counters["free"] = static_cast<double>(free) / static_cast<double>(asked);
  // Of the wishes, each as fast as it ever was.
  std::erase(least, INFINITY);
  state.counters["largest_ns"] = *std::ranges::max_element(least);
}

// The same boxes in a tree.
struct Tree {
  explicit Tree(const Crowd& crowd) {
    for (const Reservation& mover : crowd.r.movers) {
      Add(objects, mover.extent);
      manager.registerObject(objects.back().get());
    }
    manager.setup();
    for (const Crowd::Wish& wish : crowd.wishes) {
      Reservation mover = crowd.r.movers[wish.mover];
      mover.moving = true;
      mover.move = wish.move;
      Add(wishes, ExtentOf(AreaOf(mover)));
    }
  }

  using Objects = std::vector<std::unique_ptr<fcl::CollisionObjectd>>;
  static void Add(Objects& to, const Extent& e) {
    const auto box = std::make_shared<fcl::Boxd>(e.upper.x - e.lower.x, e.upper.y - e.lower.y, 100);
    to.push_back(std::make_unique<fcl::CollisionObjectd>(box));
    to.back()->setTranslation({(e.lower.x + e.upper.x) / 2, (e.lower.y + e.upper.y) / 2, 0});
    to.back()->computeAABB();
  }

  fcl::DynamicAABBTreeCollisionManagerd manager;
  Objects objects;
  Objects wishes;
};

// Which boxes that of a wish meets.
void BroadPhase(benchmark::State& state, bool turning) {
  Tree tree(Crowd(static_cast<int>(state.range(0)), turning));
  const auto meets = [](fcl::CollisionObjectd*, fcl::CollisionObjectd*, void* count) {
    ++*static_cast<long*>(count);
    return false;
  };
  std::size_t i = 0;
  for (auto _ : state) {
    long count = 0;
    tree.manager.collide(tree.wishes[i].get(), &count, meets);
    benchmark::DoNotOptimize(count);
    i = (i + 1) % tree.wishes.size();
  }
}

// A box of the tree is where the mover is.
void MoveInTree(benchmark::State& state) {
  Tree tree(Crowd(static_cast<int>(state.range(0)), false));
  std::size_t i = 0;
  for (auto _ : state) {
    fcl::CollisionObjectd& object = *tree.objects[i];
    object.setTranslation(object.getTranslation() + fcl::Vector3d(0.1, 0.1, 0));
    object.computeAABB();
    tree.manager.update(&object);
    i = (i + 1) % tree.objects.size();
  }
}

// Whether a track may be Moving: a zigzag between rows of movers.
void AskForTrack(benchmark::State& state) {
  const TrackArea track = MakeTrackArea(Make(Zigzag(10)), {155, 155}, 0);
  const TrackArea* tracks[] = {&track};
  std::vector<Place> stators;
  for (int i = 0; i < 80; ++i) stators.push_back({240.0 * (i % 20) - 240, 240.0 * (i / 20) - 360});
  Environment environment;
  MakeEnvironment(stators, environment);
  const auto count = static_cast<std::uint32_t>(state.range(0));
  Reservations r = MakeReservations(count, 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double row = i / 40;
    Settle(i, {155, 155}, {{200.0 * (i / 2 % 20), i % 2 == 0 ? -200 - 200 * row : 400 + 200 * row}, 0}, r);
  }
  std::size_t asked = 0, free = 0;
  for (auto _ : state) {
    free += AskTrack(0, {.environment = &environment, .tracks = tracks}, r).kind == ObjectKind::kNone ? 1 : 0;
    ++asked;
  }
  state.counters["free"] = static_cast<double>(free) / static_cast<double>(asked);
  state.counters["stretches"] = static_cast<double>(track.stretches.size());
}

// Two areas that nearly touch.
struct Pair {
  Area a{.places = {{{0, 0}, {200, 100}}}, .count = 2, .mover = {155, 155}};
  Area b{.places = {{{240, -60}, {500, -300}}}, .count = 2, .mover = {155, 155}};
};

void PairByAxes(benchmark::State& state) {
  const Pair pair;
  for (auto _ : state) {
    benchmark::DoNotOptimize(&pair);
    benchmark::DoNotOptimize(Near(pair.a, pair.b, 0));
  }
}

void PairByFcl(benchmark::State& state) {
  const auto a =
      testing::PrismOf({{-77.5, -77.5}, {77.5, -77.5}, {277.5, 22.5}, {277.5, 177.5}, {122.5, 177.5}, {-77.5, 77.5}});
  const auto b = testing::PrismOf(
      {{162.5, -137.5}, {422.5, -377.5}, {577.5, -377.5}, {577.5, -222.5}, {317.5, 17.5}, {162.5, 17.5}});
  for (auto _ : state) benchmark::DoNotOptimize(testing::Collide(*a, *b));
}

// The most there can be: both turn far while they pass each other closely.
void PairOfTurns(benchmark::State& state) {
  const Area a{.places = {{{0, 0}, {200, 0}}}, .count = 2, .most_c = 80, .mover = {155, 155}};
  std::vector<double> least(200, INFINITY);
  std::size_t i = 0;
  for (auto _ : state) {
    const double gap = 150 + 0.3 * static_cast<double>(i);
    const Area b{.places = {{{0, gap}, {200, gap}}}, .count = 2, .least_c = 5, .most_c = 85, .mover = {155, 155}};
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(Near(a, b, 0));
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    least[i] = std::min(least[i], time.count());
    i = (i + 1) % least.size();
  }
  std::erase(least, INFINITY);
  state.counters["largest_ns"] = *std::ranges::max_element(least);
}

void AdvanceAll(benchmark::State& state, bool turning) {
  Crowd crowd(200, turning);
  std::uint32_t i = 0;
  for (auto _ : state) {
    Pose pose = crowd.r.movers[i].pose;
    pose.place = {pose.place.x + 0.1, pose.place.y + 0.1};
    Advance(i, pose, crowd.r);
    i = (i + 1) % 200;
  }
}

// A ring of modules: a way on the ring, and a bypass around it. So many movers are on their ways to random places, and
// are sent on when they are there.
class Ring {
 public:
  Ring(std::uint32_t movers, bool guarded)
      : movers_(movers),
        guarded_(guarded),
        guard_(movers),
        traffic_({movers, Tracks()}),
        search_(Tracks()),
        riders_(movers) {
    const double radius = 450.0 * movers / (2 * M_PI);
    const auto at = [&](double share, double r) {
      const double angle = 2 * M_PI * share / modules();
      return Place{r * std::cos(angle), r * std::sin(angle)};
    };
    network_.roads.resize(Tracks());
    for (std::uint32_t i = 0; i < modules(); ++i) {
      const auto arc = [&](double from, double to) {
        return Element{ElementShape::kArc, at(i + from, radius), at(i + to, radius), {0, 0}, false};
      };
      Add(3 * i, {.elements = {arc(0, 0.2)}});
      Add(3 * i + 1, {.elements = {arc(0.2, 1)}});
      const auto outside = [&](double share) { return at(i + share, radius + 300); };
      const Track& begin = *tracks_[3 * i];
      const Track& beside = *tracks_[3 * i + 1];
      Add(3 * i + 2, {.elements = {Line(outside(0.4), outside(0.8))},
                      .from = At(begin, begin.length),
                      .to = At(beside, beside.length)});
    }
    for (std::uint32_t i = 0; i < modules(); ++i) {
      const std::uint32_t next = 3 * ((i + 1) % modules());
      for (const std::uint32_t way : {3 * i + 1, 3 * i + 2}) {
        Link(3 * i, way, network_);
        Link(way, next, network_);
      }
    }
    NumberNodes(network_);
    for (std::uint32_t i = 0; i < Tracks(); ++i) SetRanges(i, network_);
    for (std::uint32_t i = 0; i < Tracks(); ++i) SetLeads(i, network_);
    for (std::uint32_t i = 0; i < movers; ++i) {
      Rider& r = riders_[i];
      r.on = true;
      r.route.count = 1;
      r.route.tracks[0] = 3 * (i % modules()) + 1;
      r.at.position = 700 + 230.0 * (i / modules());
      r.pace = {{2000, 10000, 10000, 200000}, 5000};
      r.brakes = r.pace.brakes();
      r.top_speed = r.pace.limits.velocity;
      r.gap = 200;
      Guard::Figure& figure = guard_.figure(i);
      figure.kind = {.places = {}, .count = 0, .mover = {113, 113}, .margin = 0};
      figure.on_track = true;
      guard_.Put(i, CourseOn(network_, r, r.at.position, r.at.position, figure.kind));
    }
  }

  void Step() {
    for (Rider& r : riders_) {
      if (r.aim == Aim::kTarget && !r.there) continue;
      const auto on = static_cast<std::uint32_t>(3 * (random_() % modules()) + random_() % 3);
      Send(network_, search_, {.track = on, .position = 0.5 * network_[on].length}, r);
    }
    traffic_.Step(cycle_, planner_, network_, riders_, guarded_ ? &guard_ : nullptr);
    ++cycle_.count;
  }
  double moving() const {
    double count = 0;
    for (const Rider& r : riders_) count += r.at.velocity != 0 ? 1 : 0;
    return count / movers_;
  }

 private:
  std::uint32_t modules() const { return std::max(2U, movers_ / 10); }
  std::uint32_t Tracks() const { return 3 * modules(); }
  void Add(std::uint32_t number, const Layout& layout) {
    tracks_.push_back(std::make_unique<Track>(Make(layout)));
    network_.roads[number].track = tracks_.back().get();
    network_.roads[number].length = tracks_.back()->length;
    network_.roads[number].reach = 160;
  }

  std::uint32_t movers_;
  bool guarded_;
  Guard guard_;
  std::vector<std::unique_ptr<Track>> tracks_;
  Network network_;
  Traffic traffic_;
  RouteSearch search_;
  std::vector<Rider> riders_;
  trajectory::Planner planner_;
  std::mt19937 random_{1};
  Cycle cycle_{0, 0.001};
};

// PL-60: one cycle of all movers, orders and routes included. The same run again and again: of each of its cycles the
// least time counts, which is free of what else the computer does.
void OneCycle(benchmark::State& state, bool guarded) {
  constexpr std::size_t kCycles = 2000;
  std::unique_ptr<Ring> ring;
  std::vector<double> least(kCycles, INFINITY);
  std::size_t i = kCycles;
  double moving = 0;
  for (auto _ : state) {
    if (i == kCycles) {
      state.PauseTiming();
      ring = std::make_unique<Ring>(static_cast<std::uint32_t>(state.range(0)), guarded);
      for (int before = 0; before < 3000; ++before) ring->Step();
      i = 0;
      state.ResumeTiming();
    }
    const auto begin = std::chrono::steady_clock::now();
    ring->Step();
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
    least[i] = std::min(least[i], time.count());
    moving += ring->moving();
    ++i;
  }
  std::sort(least.begin(), least.end());
  state.counters["moving"] = moving / static_cast<double>(state.iterations());
  state.counters["mean_us"] = std::accumulate(least.begin(), least.end(), 0.0) / kCycles;
  state.counters["p98_us"] = least[kCycles * 98 / 100];
  state.counters["max_us"] = least.back();
}

BENCHMARK_CAPTURE(LookUp, given, false)->Name("AtGiven")->Arg(5)->Arg(100);
BENCHMARK_CAPTURE(LookUp, transitions, true)->Name("AtTransition")->Arg(5)->Arg(100);
BENCHMARK(FindNearest)->Name("NearestTo")->Arg(5)->Arg(20)->Arg(100);
BENCHMARK(MakeOne)->Name("MakeTrack")->Unit(benchmark::kMicrosecond);
BENCHMARK(FindConflicts)->Name("Conflicts")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(OneCycle, unguarded, false)
    ->Name("TrafficCycleUnguarded")
    ->Arg(200)
    ->Arg(800)
    ->Iterations(10000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(OneCycle, guarded, true)
    ->Name("TrafficCycle")
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Arg(400)
    ->Arg(800)
    ->Iterations(10000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(AskFor, straight, false)->Name("Reservation/takt")->Arg(200)->Arg(800);
BENCHMARK_CAPTURE(BroadPhase, straight, false)->Name("Reservation/fcl")->Arg(200)->Arg(800);
BENCHMARK_CAPTURE(AskFor, turning, true)->Name("ReservationOfTurns/takt")->Arg(200)->Arg(800);
BENCHMARK_CAPTURE(BroadPhase, turning, true)->Name("ReservationOfTurns/fcl")->Arg(200)->Arg(800);
BENCHMARK(AskForTrack)->Name("ReservationOfTrack")->Arg(200);
BENCHMARK(PairByAxes)->Name("PairOfAreas/takt");
BENCHMARK(PairByFcl)->Name("PairOfAreas/fcl");
BENCHMARK(PairOfTurns);
BENCHMARK_CAPTURE(AdvanceAll, straight, false)->Name("Advance/takt/200");
BENCHMARK(MoveInTree)->Name("Advance/fcl")->Arg(200);
BENCHMARK_CAPTURE(AdvanceAll, turning, true)->Name("AdvanceInATurn");

}  // namespace
}  // namespace takt::planar
