// PL-30: reservations: the manual's programs, what is reserved and released, and random traffic without collisions.
#include "takt/planar/reservation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <vector>

#include "../core/allocations.h"
#include "../core/trials.h"
#include "areas.h"
#include "takt/core/describe.h"
#include "takt/core/hash.h"
#include "takt/core/verify.h"

namespace takt {

void PrintTo(const ObjectInfo& object, std::ostream* stream) {
  const char* kinds[] = {"nothing", "mover", "track", "group", "environment", "part", "coordinate system"};
  *stream << kinds[static_cast<int>(object.kind)] << ' ' << object.number;
}

namespace planar {
namespace {

using testing::AsPoint;
using testing::DistanceByAngles;
using testing::Line;
using testing::Random;
using testing::RandomTrack;
using testing::Surface;

constexpr Footprint kMover{155, 155};
constexpr ObjectInfo kFree{};
constexpr ObjectInfo kBorder{ObjectKind::kEnvironment, 1};

ObjectInfo Mover(std::uint32_t number) {
  return {ObjectKind::kMover, number + 1};
}
ObjectInfo TrackOf(std::uint32_t number) {
  return {ObjectKind::kTrack, number + 1};
}
Move To(double x, double y, double c = 0) {
  return {.target = {{x, y}, c}};
}
Pose At(double x, double y, double c = 0) {
  return {{x, y}, c};
}

// PL-30: the manual's program 6.3.2: mover one moves from (0, 0) to (0, 240), mover two is at (240, 0) and is sent to
// (0, 0) at the same time: refused while mover one is still there; admitted later.
TEST(ReservationsOfMovers, RefuseWhatIsTaken) {
  Reservations r = MakeReservations(2, 0);
  Settle(0, kMover, At(0, 0), r);
  Settle(1, kMover, At(240, 0), r);
  EXPECT_EQ(Ask(0, To(0, 240), {}, r), kFree);
  Take(0, To(0, 240), r);
  EXPECT_EQ(Ask(1, To(0, 0), {}, r), Mover(0));
  Advance(0, At(0, 240), r);
  EXPECT_EQ(Ask(1, To(0, 0), {}, r), kFree);
  End(0, r);
  EXPECT_EQ(Ask(1, To(0, 0), {}, r), kFree);
  EXPECT_EQ(Ask(1, To(0, 100), {}, r), Mover(0));
}

// PL-30: the manual's program 6.7.2: one stator about the origin; the mover cannot move to (100, 100).
TEST(ReservationsOfMovers, RefuseTheBorder) {
  const Environment environment = Surface({{-120, -120}});
  Reservations r = MakeReservations(1, 0);
  Settle(0, kMover, At(0, 0), r);
  EXPECT_EQ(Ask(0, To(100, 100), {.environment = &environment}, r), kBorder);
  EXPECT_EQ(Ask(0, To(42.5, -42.5), {.environment = &environment}, r), kFree);
  EXPECT_EQ(Ask(0, To(100, 100), {}, r), kFree);
}

// PL-30: the manual's program 6.5: a track from (0, 0) to (400, 0) with mover one on it; mover two blocks it until it
// has moved to (240, 320). While the track is Moving nothing else may enter it.
TEST(ReservationsOfTracks, RefuseWhatIsTaken) {
  const Track track = testing::Make({.elements = {Line({0, 0}, {400, 0})}});
  const TrackArea area = MakeTrackArea(track, kMover, 7);
  const TrackArea* tracks[] = {&area};
  const StaticObstacles around{.tracks = tracks};
  Reservations r = MakeReservations(2, 1);
  Settle(0, kMover, At(0, 0), r);
  Settle(1, kMover, At(240, 0), r);
  EXPECT_EQ(AskTrack(0, around, r), Mover(0));
  Link(0, 7, r);
  EXPECT_EQ(AskTrack(0, around, r), Mover(1));
  EXPECT_EQ(Ask(1, To(240, 320), around, r), kFree);
  Take(1, To(240, 320), r);
  // On the move it still reaches into the track.
  Advance(1, At(240, 154), r);
  EXPECT_EQ(AskTrack(0, around, r), Mover(1));
  Advance(1, At(240, 155.1), r);
  EXPECT_EQ(AskTrack(0, around, r), kFree);
  TakeTrack(0, r);
  Advance(1, At(240, 320), r);
  End(1, r);
  EXPECT_EQ(Ask(1, To(240, 0), around, r), TrackOf(0));
  EXPECT_EQ(Ask(1, To(240, 155.1), around, r), kFree);
  EndTrack(0, r);
  EXPECT_EQ(Ask(1, To(240, 0), around, r), kFree);
  // The border, and tracks of other networks, count; those of its own do not.
  const Environment narrow = Surface({{-120, -120}, {120, -120}});
  EXPECT_EQ(AskTrack(0, {.environment = &narrow, .tracks = tracks}, r), kBorder);
  const Environment wide = Surface({{-120, -120}, {120, -120}, {360, -120}});
  EXPECT_EQ(AskTrack(0, {.environment = &wide, .tracks = tracks}, r), kFree);
  const TrackArea crossing = MakeTrackArea(testing::Make({.elements = {Line({200, -300}, {200, -100})}}), kMover, 8);
  TrackArea linked = crossing;
  linked.network = 7;
  Reservations two = MakeReservations(0, 2);
  TakeTrack(1, two);
  const TrackArea* others[] = {&area, &crossing};
  EXPECT_EQ(AskTrack(0, {.tracks = others}, two), TrackOf(1));
  others[1] = &linked;
  EXPECT_EQ(AskTrack(0, {.tracks = others}, two), kFree);
  // A track that is not in the group.
  others[1] = nullptr;
  EXPECT_EQ(AskTrack(0, {.tracks = others}, two), kFree);
  EXPECT_EQ(AskTrack(1, {.tracks = others}, two), kFree);
}

// PL-30: the area that a mover has left is free again, up to the mover.
TEST(ReservationsOfMovers, AreFreedAsTheyAreLeft) {
  Reservations r = MakeReservations(2, 0);
  Settle(0, kMover, At(0, 0), r);
  Settle(1, kMover, At(0, 400), r);
  Take(0, To(1000, 0), r);
  for (double x = 0; x <= 1000; x += 50) {
    Advance(0, At(x, 0), r);
    EXPECT_EQ(Ask(1, {.target = At(x - 155.1, 400), .over = {}}, {}, r), kFree);
    Settle(1, kMover, At(x - 155.1, 400), r);
    EXPECT_EQ(Ask(1, To(x - 155.1, 0), {}, r), kFree) << x;
    Settle(1, kMover, At(x - 154.9, 400), r);
    EXPECT_EQ(Ask(1, To(x - 154.9, 0), {}, r), Mover(0)) << x;
    Settle(1, kMover, At(1154.9, 400), r);
    EXPECT_EQ(Ask(1, To(1154.9, 0), {}, r), Mover(0)) << x;
    Settle(1, kMover, At(1155.1, 400), r);
    EXPECT_EQ(Ask(1, To(1155.1, 0), {}, r), kFree) << x;
  }
  // Halted underway: the rest is free once it is at rest.
  Advance(0, At(600, 0), r);
  End(0, r);
  EXPECT_EQ(Ask(1, To(1000, 0), {}, r), kFree);
  // Removed.
  Leave(0, r);
  EXPECT_EQ(Ask(1, To(600, 0), {}, r), kFree);
}

// PL-30: a mover in motion along X is sent to (300, 300); it would come to rest on its old line at (200, 0). Until it
// has turned off it reserves the triangle, whose side runs from (277.5, -77.5) to (377.5, 222.5); from then on the rest
// of the straight line.
TEST(ReservationsOfMovers, CoverTheWayToTurn) {
  Reservations r = MakeReservations(2, 0);
  Settle(0, kMover, At(0, 0), r);
  Settle(1, kMover, At(373.4, -100), r);
  const Move turn{.target = At(300, 300), .over = Place{200, 0}};
  EXPECT_EQ(Ask(0, turn, {}, r), kFree);
  Settle(1, kMover, At(373.2, -100), r);
  EXPECT_EQ(Ask(0, turn, {}, r), Mover(1));
  Settle(1, kMover, At(-100, -200), r);
  Take(0, turn, r);
  Advance(0, At(100, 0), r);
  EXPECT_EQ(Ask(1, To(-60, 0), {}, r), kFree);
  EXPECT_EQ(Ask(1, To(100, -150), {}, r), Mover(0));
  // It cut the corner, and is on its new line.
  Advance(0, At(230, 90), r);
  EXPECT_EQ(Ask(1, To(100, -150), {}, r), kFree);
  EXPECT_EQ(Ask(1, To(200, -66), {}, r), kFree);
  EXPECT_EQ(Ask(1, To(200, -64), {}, r), Mover(0));
}

// PL-30: a mover sent back has to come to rest first; until then it reserves the distance that it still moves on.
TEST(ReservationsOfMovers, CoverTheWayToReturn) {
  Reservations r = MakeReservations(2, 0);
  Settle(0, kMover, At(0, 0), r);
  Settle(1, kMover, At(340, 200), r);
  const Move back{.target = At(-300, 0), .over = Place{200, 0}};
  EXPECT_EQ(Ask(0, back, {}, r), kFree);
  Take(0, back, r);
  for (const double x : {50.0, 150.0, 200.0}) {
    Advance(0, At(x, 0), r);
    EXPECT_EQ(Ask(1, To(340, 0), {}, r), Mover(0)) << x;
  }
  Advance(0, At(180, 0), r);
  EXPECT_EQ(Ask(1, To(340, 0), {}, r), kFree);
  EXPECT_EQ(Ask(1, To(330, 0), {}, r), Mover(0));
}

// PL-30: a rotation reserves room, and releases it.
TEST(ReservationsOfMovers, CoverTurns) {
  Reservations r = MakeReservations(2, 0);
  Settle(0, kMover, At(0, 0), r);
  Settle(1, kMover, At(160, 0), r);
  EXPECT_EQ(Ask(0, To(0, 0, 90), {}, r), Mover(1));
  // It may rotate first, and move then.
  EXPECT_EQ(Ask(0, To(-30, 0, 90), {}, r), Mover(1));
  EXPECT_EQ(Ask(0, To(0, 0, 1), {}, r), kFree);
  EXPECT_EQ(Ask(0, {.target = At(0, 0, 1), .over_c = -30.0}, {}, r), Mover(1));
  Settle(1, kMover, At(180, 0), r);
  // At 45° a corner is 109.6 mm out, at 60° 105.9 mm, at 75° 94.9 mm.
  Take(0, To(0, 0, 90), r);
  EXPECT_EQ(Ask(1, To(185, 0), {}, r), Mover(0));
  EXPECT_EQ(Ask(1, To(188, 0), {}, r), Mover(0));
  Settle(1, kMover, At(188, 0), r);
  EXPECT_EQ(Ask(1, To(188, 10), {}, r), kFree);
  Settle(1, kMover, At(400, 0), r);
  EXPECT_EQ(Ask(1, To(186, 0), {}, r), Mover(0));
  Advance(0, At(0, 0, 60), r);
  EXPECT_EQ(Ask(1, To(186, 0), {}, r), kFree);
  EXPECT_EQ(Ask(1, To(182, 0), {}, r), Mover(0));
  Advance(0, At(0, 0, 75), r);
  EXPECT_EQ(Ask(1, To(175, 0), {}, r), kFree);
}

// PL-30: around a bend of 100 mm the outer corners of a square of 155 mm move at 193.68 mm, its inner side at 22.5 mm.
// mm.
TEST(AreasOfTracks, FollowBends) {
  const Track track = testing::Make({.elements = {testing::Arc({100, 0}, {0, 100}, {0, 0}, false)}});
  const TrackArea area = MakeTrackArea(track, kMover, 0);
  const double outer = std::hypot(177.5, 77.5);
  for (double degrees = 0; degrees <= 90; degrees += 0.37) {
    const auto near = [&](double radius) {
      Area probe;
      probe.places[0] = testing::Ahead({}, degrees / 180 * 3.14159265358979, radius);
      probe.least_c = probe.most_c = degrees;
      probe.mover = {0.02, 0.02};
      return Near(probe, ExtentOf(probe), area, kSame);
    };
    EXPECT_TRUE(near(outer)) << degrees;
    EXPECT_FALSE(near(outer + kTrackSlack + 0.02)) << degrees;
    EXPECT_TRUE(near(22.5)) << degrees;
    EXPECT_FALSE(near(22.5 - kTrackSlack - 0.02)) << degrees;
  }
}

// PL-30: the area of a track covers the mover everywhere on it, and hardly more.
TEST(AreasOfTracks, AreThoseOfTheirMovers) {
  Random random(51);
  int near = 0, far = 0;
  for (int i = 0; i < Trials(20); ++i) {
    const Track track = RandomTrack(random);
    const Footprint mover{random.Between(50, 160), random.Between(50, 160), random.Below(4) == 0};
    const TrackArea area = MakeTrackArea(track, mover, 0);
    std::vector<TrackPoint> points;
    const int count = static_cast<int>(track.length) * 2;
    for (int k = 0; k <= count; ++k) points.push_back(At(track, track.length * k / count));
    for (int k = 0; k < 100; ++k) {
      // About where the area of a mover on the track ends.
      const TrackPoint beside = points[static_cast<std::size_t>(random.Below(count + 1))];
      const double reach = random.Between(0.9, 2) * std::max(mover.width, mover.height);
      Area other;
      other.places[0] = testing::Ahead(beside.place, random.Between(-3, 3), reach);
      other.least_c = other.most_c = random.Between(-180, 180);
      other.mover = {random.Between(10, 80), random.Between(10, 80)};
      double least = INFINITY;
      for (const TrackPoint& p : points) {
        least = std::min(least, Separation(p, mover, AsPoint({other.places[0], other.least_c}), other.mover));
      }
      const bool said = Near(other, ExtentOf(other), area, 0);
      if (least < 0) {
        EXPECT_TRUE(said);
      }
      if (said) {
        // Distance that a corner moves between samples.
        const double sampling =
            0.25 * (1 + std::hypot(mover.width, mover.height) / 2 * PeakCurvature(track, 0, track.length));
        EXPECT_LT(least, kTrackSlack + sampling);
      }
      (said ? near : far) += 1;
    }
  }
  EXPECT_GT(near, Trials(300));
  EXPECT_GT(far, Trials(300));
}

// Movers sent about at random on a surface with a hole, each at any speed along its path and in its rotation.
class RandomTraffic {
 public:
  RandomTraffic(unsigned seed, bool turning) : random_(seed), turning_(turning) {
    std::vector<Place> stators;
    for (int x = 0; x < 7; ++x) {
      for (int y = 0; y < 7; ++y) {
        if (x < 3 || x > 4 || y != 3) stators.push_back({240.0 * x, 240.0 * y});
      }
    }
    surface_ = Surface(stators);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const Footprint footprint{random_.Between(100, 155), random_.Between(100, 155)};
      Settle(i, footprint, At(120 + 240 * (i % 7), 120 + 480 * (i / 7)), r);
      motions_.push_back({});
    }
  }

  // One instant later.
  void Step() {
    for (std::uint32_t i = 0; i < kCount; ++i) {
      if (r.movers[i].moving) {
        Go(i);
      } else if (random_.Below(4) == 0) {
        Send(i);
      }
    }
  }

  // A mover in motion is sometimes sent elsewhere, halted, or arrives.
  void Go(std::uint32_t i) {
    Motion& m = motions_[i];
    const double end = m.legs.size() > 2 ? 2 : 1;
    m.way = std::min(end, m.way + random_.Between(0, 0.15));
    m.turn = std::min(1.0, m.turn + random_.Between(0, 0.15));
    const auto leg = static_cast<std::size_t>(std::min(m.way, end - 1e-12));
    const double share = m.way - static_cast<double>(leg);
    const Place &p = m.legs[leg], &q = m.legs[leg + 1];
    Advance(i, {{std::lerp(p.x, q.x, share), std::lerp(p.y, q.y, share)}, std::lerp(m.from_c, m.to_c, m.turn)}, r);
    if (m.way == end && m.turn == 1) {
      End(i, r);
      ++arrived;
    } else if (random_.Below(40) == 0) {
      End(i, r);
    } else if (random_.Below(30) == 0) {
      Send(i);
    }
  }

  void Send(std::uint32_t i) {
    const Reservation& own = r.movers[i];
    Move move{.target = At(random_.Between(50, 1630), random_.Between(50, 1630), own.pose.c)};
    if (random_.Coin()) move.target.place = {own.pose.place.x + random_.Between(-200, 200), own.pose.place.y};
    if (random_.Below(5) == 0) move.target.place = own.pose.place;
    if (turning_ && random_.Coin()) move.target.c += random_.Between(-1, 1) * (random_.Coin() ? 15 : 120);
    if (own.moving) {
      // It first continues on its old path for a while, which it has reserved.
      const Motion& m = motions_[i];
      const Place& to = m.legs[static_cast<std::size_t>(m.way) + 1 < m.legs.size() ? static_cast<std::size_t>(m.way) + 1
                                                                                   : m.legs.size() - 1];
      const double share = random_.Between(0, 1);
      // Sometimes back the way it came.
      if (random_.Below(3) == 0) {
        move.target.place = {2 * own.pose.place.x - to.x, 2 * own.pose.place.y - to.y};
      }
      move.over = Place{std::lerp(own.pose.place.x, to.x, share), std::lerp(own.pose.place.y, to.y, share)};
    }
    const ObjectInfo object = Ask(i, move, {.environment = &surface_}, r);
    if (object == kFree) {
      motions_[i] = {.legs = {own.pose.place}, .from_c = own.pose.c, .to_c = move.target.c};
      if (move.over) motions_[i].legs.push_back(*move.over);
      motions_[i].legs.push_back(move.target.place);
      Take(i, move, r);
      ++taken;
      return;
    }
    Justify(i, move, object);
  }

  // A refused move would come near to the object named, at some instant of some motion.
  void Justify(std::uint32_t i, const Move& move, const ObjectInfo& object) {
    Reservation wish = r.movers[i];
    wish.moving = true;
    wish.move = move;
    const Area area = AreaOf(wish);
    if (object.kind == ObjectKind::kEnvironment) {
      ++at_border;
    } else if (refused++ % 10 == 0) {
      EXPECT_LT(DistanceByAngles(area, AreaOf(r.movers[object.number - 1])), kSlack);
    }
  }

  void ExpectApart() const {
    for (std::size_t i = 0; i < kCount; ++i) {
      const Reservation& a = r.movers[i];
      const Area area{.places = {a.pose.place}, .least_c = a.pose.c, .most_c = a.pose.c, .mover = a.mover};
      EXPECT_TRUE(Carries(surface_, area));
      for (std::size_t k = 0; k < i; ++k) {
        const Reservation& b = r.movers[k];
        EXPECT_GT(Separation(AsPoint(a.pose), a.mover, AsPoint(b.pose), b.mover), 0) << i << ' ' << k;
      }
    }
  }

  static constexpr std::uint32_t kCount = 21;
  Reservations r = MakeReservations(kCount, 0);
  int taken = 0, refused = 0, at_border = 0, arrived = 0;

 private:
  // Along the legs, 1 for each.
  struct Motion {
    std::vector<Place> legs{};
    double way = 0;
    double from_c = 0;
    double to_c = 0;
    double turn = 0;
  };

  Random random_;
  bool turning_;
  Environment surface_;
  std::vector<Motion> motions_;
};

// PL-30: whatever is requested, no two movers ever touch and none leaves the surface; and each refusal has a reason.
TEST(ReservationsOfMovers, KeepMoversApart) {
  for (const bool turning : {false, true}) {
    RandomTraffic traffic(52, turning);
    for (int i = 0; i < Trials(3000) && !::testing::Test::HasFailure(); ++i) {
      traffic.Step();
      traffic.ExpectApart();
    }
    EXPECT_GT(traffic.taken, Trials(2000));
    EXPECT_GT(traffic.arrived, Trials(500));
    EXPECT_GT(traffic.refused, Trials(1000));
    EXPECT_GT(traffic.at_border, Trials(150));
  }
}

// PL-30, EN-06: fit for the cycle; all state can be copied and compared.
TEST(ReservationsOfMovers, AllocateNothing) {
  const Environment surface = Surface({{0, 0}, {240, 0}, {480, 0}});
  const TrackArea area = MakeTrackArea(testing::Make({.elements = {Line({120, 120}, {300, 120})}}), kMover, 0);
  const TrackArea* tracks[] = {&area};
  const StaticObstacles around{.environment = &surface, .tracks = tracks};
  Reservations r = MakeReservations(2, 1);
  const long before = AllocationsOfThisThread();
  Settle(0, kMover, At(120, 120), r);
  Settle(1, kMover, At(600, 120), r);
  const ObjectInfo refused = Ask(0, To(480, 120, 30), around, r);
  const ObjectInfo free = Ask(0, To(300, 120), around, r);
  Take(0, To(300, 120), r);
  Advance(0, At(200, 120), r);
  End(0, r);
  Link(0, 0, r);
  const ObjectInfo track = AskTrack(0, around, r);
  TakeTrack(0, r);
  const ObjectInfo blocked = Ask(1, To(400, 120), around, r);
  EndTrack(0, r);
  EXPECT_EQ(AllocationsOfThisThread(), before);
  EXPECT_EQ(refused, Mover(1));
  EXPECT_EQ(free, kFree);
  EXPECT_EQ(track, kFree);
  EXPECT_EQ(blocked, TrackOf(0));
}

// EN-11: all state is described, so that it is hashed, copied and replayed.
TEST(ReservationsOfMovers, AreDescribed) {
  EXPECT_THAT(Verify(TypeOf<Reservations>()), ::testing::IsEmpty());
  Reservations r = MakeReservations(2, 1);
  Settle(0, kMover, At(0, 0), r);
  const Reservations before = r;
  Take(0, {.target = At(200, 0, 10), .over = Place{20, 20}, .over_c = -3.0}, r);
  EXPECT_NE(HashOf(r), HashOf(before));
  const Reservations copy = r;
  EXPECT_TRUE(Equal(copy, r));
  EXPECT_EQ(Ask(1, To(200, 0), {}, copy), Mover(0));
  End(0, r);
  EXPECT_TRUE(Equal(before, r));
}

}  // namespace
}  // namespace planar
}  // namespace takt
