// PL-32: the border of adjacent parts is that of all their stators together, wherever they move.
#include "takt/planar/parts.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace takt::planar {
namespace {

Part MakePart(const std::string& name, const std::vector<Place>& stators, const std::vector<Spot>& positions) {
  Part part{.name = name, .shape = {}, .positions = positions};
  EXPECT_EQ(MakeEnvironment(stators, part.shape).problem, StatorProblem::kNone);
  return part;
}

double LengthOf(const std::vector<Side>& border) {
  double length = 0;
  for (const Side& s : border) length += std::abs(s.to.x - s.from.x) + std::abs(s.to.y - s.from.y);
  return length;
}

TEST(Parts, ReferencesAreResolved) {
  Parts none;
  EXPECT_TRUE(Resolve(none, "").has_value());
  EXPECT_FALSE(Resolve(none, "plane").has_value());
  Parts one({"plane"}, {MakePart("a", {{0, 0}}, {{0, {240, 0}}})}, {{}});
  EXPECT_EQ(*Resolve(one, ""), (Spot{0, {0, 0}}));
  EXPECT_EQ(*Resolve(one, "plane"), (Spot{0, {0, 0}}));
  EXPECT_EQ(*Resolve(one, "a"), (Spot{0, {240, 0}}));
  EXPECT_FALSE(Resolve(one, "b").has_value());
  one.now[0].away = true;
  EXPECT_FALSE(Resolve(one, "a").has_value());
  Parts moves({"plane"}, {MakePart("a", {{0, 0}}, {{0, {}}, {0, {240, 0}}})}, {{}});
  EXPECT_FALSE(Resolve(moves, "").has_value());
  Parts two({"one", "two"}, {MakePart("a", {{0, 0}}, {{1, {}}})}, {{}});
  EXPECT_FALSE(Resolve(two, "").has_value());
}

// Parts flush with each other, shifted along their border, and apart.
TEST(Parts, BordersGoAroundAll) {
  const auto border = [](const Place& at) {
    Parts parts({"plane"}, {MakePart("a", {{0, 0}}, {{0, {}}}), MakePart("b", {{0, 0}}, {{0, at}})}, {{}, {}});
    return LengthOf(parts.borders[0]);
  };
  EXPECT_DOUBLE_EQ(border({240, 0}), 6 * 240);
  EXPECT_DOUBLE_EQ(border({240, 100}), 8 * 240 - 2 * 140);
  EXPECT_DOUBLE_EQ(border({-100, 240}), 8 * 240 - 2 * 140);
  EXPECT_DOUBLE_EQ(border({240, 240}), 8 * 240);  // movers cannot pass a corner
  EXPECT_DOUBLE_EQ(border({240.5, 0}), 8 * 240);
}

TEST(Parts, AreConnected) {
  EXPECT_TRUE(AreConnected(std::vector<Place>{{0, 0}}));
  EXPECT_TRUE(AreConnected(std::vector<Place>{{0, 0}, {480, 0}, {240, 0}}));
  EXPECT_TRUE(AreConnected(std::vector<Place>{{0, 0}, {240, 200}}));
  EXPECT_FALSE(AreConnected(std::vector<Place>{{0, 0}, {240, 240}}));
  EXPECT_FALSE(AreConnected(std::vector<Place>{{0, 0}, {241, 0}}));
}

// The same as for one surface with all stators present: by the functions for that, which are tested elsewhere.
TEST(Parts, CarryWhatAllStatorsTogetherCarry) {
  std::mt19937 random(3);
  const auto whole = [&](int from, int to) { return std::uniform_int_distribution<int>(from, to)(random); };
  const auto uniform = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  int carried = 0, across = 0, asked = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Part> all;
    const std::vector<Place> shapes[] = {{{0, 0}}, {{0, 0}, {240, 0}}, {{0, 0}, {0, 240}, {240, 240}}};
    const int count = whole(2, 6);
    for (int i = 0; i < count; ++i) {
      std::vector<Spot> spots;
      for (int k = 0; k < 4; ++k) {
        const double shift = whole(0, 3) == 0 ? uniform(0, 240) : 0;
        spots.push_back(
            {static_cast<std::uint32_t>(whole(0, 1)), {240.0 * whole(-1, 2) + shift, 240.0 * whole(-1, 2)}});
      }
      all.push_back(MakePart("p" + std::to_string(i), shapes[whole(0, 2)], spots));
    }
    Parts parts({"one", "two"}, all, std::vector<PartNow>(all.size(), {.away = true}));
    const std::size_t room = parts.borders[0].capacity();
    for (int moves = 0; moves < 10; ++moves) {
      // If it overlaps nothing it moves there, or else it is removed.
      const auto part = static_cast<std::uint32_t>(whole(0, count - 1));
      const auto position = static_cast<std::uint32_t>(whole(0, 3));
      bool free = true;
      for (std::uint32_t k = 0; k < parts.all.size(); ++k) {
        free &= k == part || parts.now[k].away ||
                !Overlap(parts.all[part], parts.all[part].positions[position], parts.all[k], parts.spot(k));
      }
      parts.now[part].position = position;
      parts.now[part].away = !free;
      MakeBorders(parts);
      EXPECT_EQ(parts.borders[0].capacity(), room);
      for (std::uint32_t system = 0; system < 2; ++system) {
        std::vector<Place> stators;
        for (std::uint32_t k = 0; k < parts.all.size(); ++k) {
          if (parts.now[k].away || parts.spot(k).system != system) continue;
          for (const Place& p : parts.all[k].shape.stators) stators.push_back(p + parts.spot(k).origin);
        }
        Environment together;
        if (MakeEnvironment(stators, together).problem != StatorProblem::kNone) continue;
        for (int i = 0; i < 20; ++i) {
          Area area;
          area.count = static_cast<std::uint8_t>(whole(1, 3));
          for (std::size_t k = 0; k < area.count; ++k) area.places[k] = {uniform(-300, 800), uniform(-300, 800)};
          if (area.count > 1) area.places[1] = area.places[0] + Place{uniform(-200, 200), uniform(-200, 200)};
          area.least_c = uniform(-90, 90);
          area.most_c = area.least_c + (whole(0, 1) ? uniform(0, 30) : 0);
          area.mover = {uniform(50, 155), uniform(50, 155)};
          const bool expected = planar::Carries(together, area);
          EXPECT_EQ(Carries(parts, system, area), expected);
          ++asked;
          carried += expected;
          if (!expected) continue;
          int touched = 0;
          for (std::uint32_t k = 0; k < parts.all.size(); ++k) {
            touched += !parts.now[k].away && Touches(parts.all[k], parts.spot(k), system, area) ? 1 : 0;
          }
          EXPECT_GE(touched, 1);
          across += touched > 1;
          EXPECT_NE(PartAt(parts, system, area.places[0], kNoPart), kNoPart);
        }
      }
    }
  }
  EXPECT_GT(asked, 20000);
  EXPECT_GT(carried, 1000);
  EXPECT_GT(across, 100);
}

}  // namespace
}  // namespace takt::planar
