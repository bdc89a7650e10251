#include "takt/kinematics/links.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "takt/core/maths.h"
#include "takt/kinematics/rotations.h"

namespace takt::kinematics {
namespace {

using KDL::Vector;

const char* const kBase = "base";
const char* const kTool = "tool";
constexpr double kUnknown = std::numeric_limits<double>::infinity();

double Distance(const Vector& point, const Vector& on_axis, const Vector& direction) {
  return (direction * (point - on_axis)).Norm();
}

// --- Gantries: a link is the set of the coordinates that it moves with ---------------------------------------------

constexpr unsigned kPlaces = 0b0111;  // X, Y, Z
constexpr unsigned kTurn = 0b1000;    // C

unsigned Moved(const Linear& linear) {
  unsigned moved = 0;
  for (std::size_t c = 0; c < 4; ++c) moved |= linear.moves[c] ? 1u << c : 0u;
  return moved;
}

struct LinearLinks {
  std::array<unsigned, kMaxLinks> coordinates{};
  std::size_t count = 0;
};

LinearLinks LinksOf(const Linear& linear) {
  const unsigned moved = Moved(linear);
  LinearLinks links;
  for (int size = 0; size <= 3; ++size) {
    for (unsigned set = 0; set <= kPlaces; ++set) {
      if (std::popcount(set) == size && (set & ~moved) == 0) links.coordinates[links.count++] = set;
    }
  }
  links.coordinates[links.count++] = moved;
  return links;
}

std::vector<LinkInfo> Describe(const Linear& linear) {
  const LinearLinks links = LinksOf(linear);
  std::vector<LinkInfo> out(links.count);
  const std::size_t tool = links.count - 1;
  for (std::size_t i = 0; i < tool; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (links.coordinates[i] >> c & 1) out[i].name += "xyz"[c];
    }
    for (std::size_t j = 0; j < tool; ++j) {
      const unsigned apart = links.coordinates[i] ^ links.coordinates[j];
      if (std::popcount(apart) == 1) out[i].neighbours.push_back(j);
    }
  }
  const std::size_t carrier = tool - 1;
  if (!linear.moves[3]) {  // the tool is fixed to the last carriage
    for (const std::size_t i : out[carrier].neighbours) {
      out[i].neighbours.push_back(tool);
      out[tool].neighbours.push_back(i);
    }
  }
  out[carrier].neighbours.push_back(tool);
  out[tool].neighbours.push_back(carrier);
  return out;
}

Reason FramesOf(const Linear& linear, const Joints& joints, LinkFrameArray& out) {
  const LinearLinks links = LinksOf(linear);
  Frame tool;
  if (const Reason reason = Forward(linear, joints, tool); reason != Reason::kNone) return reason;
  for (std::size_t i = 0; i + 1 < links.count; ++i) {
    out[i] = Frame::Identity();
    for (int c = 0; c < 3; ++c) {
      if (links.coordinates[i] >> c & 1) out[i].p(c) = tool.p(c);
    }
  }
  out[links.count - 1] = tool;
  return Finite(tool) ? Reason::kNone : Reason::kNotFinite;
}

void Complete(const Linear& linear, const Joints& from, const Joints& to, Sweep& sweep) {
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < linear.count; ++i) sweep.shift[c] += linear.to_tool[c][i] * (to[i] - from[i]);
    sweep.shift[c] = std::abs(sweep.shift[c]);
  }
}

double MoveOf(const Linear& linear, const Sweep& sweep, std::size_t link, std::size_t seen_from, const Vector& point,
              double radius) {
  const LinearLinks links = LinksOf(linear);
  const unsigned apart = links.coordinates[link] ^ links.coordinates[seen_from];
  Vector shift;
  for (int c = 0; c < 3; ++c) {
    if (apart >> c & 1) shift(c) = sweep.shift[static_cast<std::size_t>(c)];
  }
  if ((apart & kTurn) == 0) return shift.Norm();
  const Vector& axis = sweep.start[links.count - 1].p;
  return shift.Norm() + sweep.shift[3] * (Distance(sweep.start[link] * point, axis, {0, 0, 1}) + radius);
}

// --- Chains: link i moves with axes 1 to i, and the tool with the last link ----------------------------------------

Vector SpanOf(const Chain& chain, std::size_t link) {
  return link < chain.count ? chain.links[link].before.p : chain.tool.p;
}

std::vector<LinkInfo> Describe(const Chain& chain) {
  std::vector<LinkInfo> out(chain.count + 2);
  for (std::size_t i = 1; i <= chain.count; ++i)
    out[i] = {"link_" + std::to_string(i), SpanOf(chain, i), {i - 1, i + 1}};
  const std::size_t tool = chain.count + 1;
  out[0].neighbours = {1};
  out[tool].neighbours = {tool - 1, tool - 2};
  out[tool - 2].neighbours.push_back(tool);
  return out;
}

std::vector<LinkInfo> Describe(const Scara& scara) {
  std::vector<LinkInfo> all = Describe(scara.chain);
  all[1].name = "arm_1";
  all[2] = {"arm_2", Vector(scara.second_arm, 0, 0), all[2].neighbours};
  all[3].name = "spindle";
  all[4].name = "flange";
  return all;
}

std::vector<LinkInfo> Describe(const SixAxis& arm) {
  return Describe(arm.chain);
}

// URDF's own names. A link keeps link_N if its own name is base or tool, that of another link (cut to the capacity of a
// name), or the link_N of another one.
std::vector<LinkInfo> Describe(const Serial& serial) {
  const std::vector<LinkInfo> numbered = Describe(serial.chain);
  std::vector<LinkInfo> all = numbered;
  const std::size_t count = serial.chain.count;
  const auto named = serial.links.begin(), end = named + static_cast<std::ptrdiff_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name(serial.links[i].view());
    const bool single = std::count(named, end, serial.links[i]) == 1;
    if (!name.empty() && name != kBase && name != kTool && single) all[i + 1].name = name;
  }
  // A link that falls back to its number may take that name from another one, which then falls back, too.
  for (std::size_t round = 0; round < count; ++round) {
    for (std::size_t i = 1; i <= count; ++i) {
      const bool taken =
          std::any_of(all.begin() + 1, all.begin() + static_cast<std::ptrdiff_t>(count) + 1,
                      [&](const LinkInfo& other) { return &other != &all[i] && other.name == all[i].name; });
      if (taken) all[i].name = numbered[i].name;
    }
  }
  return all;
}

Reason FramesOf(const Chain& chain, const Joints& joints, LinkFrameArray& out) {
  out[0] = Frame::Identity();
  for (std::size_t i = 0; i < chain.count; ++i) {
    const Link& link = chain.links[i];
    Frame& frame = out[i + 1];
    frame = out[i] * link.before;
    if (link.kind == JointKind::kLinear) {
      frame.p += frame.M * (link.axis * joints[i]);
    } else {
      frame.M = frame.M * About(link.axis, joints[i]);
    }
  }
  out[chain.count + 1] = out[chain.count] * chain.tool;
  return Finite(out[chain.count + 1]) ? Reason::kNone : Reason::kNotFinite;
}

void Complete(const Chain&, const Joints&, const Joints&, Sweep&) {}

// Takes the axes between the two links one by one, the one nearest to the point last: each axis then moves the point at
// the distance that it has at the start.
double MoveOf(const Chain& chain, const Sweep& sweep, std::size_t link, std::size_t seen_from, const Vector& point,
              double radius) {
  const Vector place = sweep.start[link] * point;
  const auto [first, last] = std::minmax(std::min(link, chain.count), std::min(seen_from, chain.count));
  double move = 0;
  for (std::size_t i = first; i < last; ++i) {
    const Frame& frame = sweep.start[i + 1];
    const bool turns = chain.links[i].kind == JointKind::kRotary;
    const double lever = turns ? Distance(place, frame.p, frame.M * chain.links[i].axis) + radius : 1;
    move += sweep.way[i] * lever;
  }
  return move;
}

// --- Delta ---------------------------------------------------------------------------------------------------------

constexpr std::size_t kUpper = 1;
constexpr std::size_t kLower = 4;
constexpr std::size_t kPlatform = 10;
constexpr std::size_t kDeltaTool = 11;

std::size_t ArmOf(std::size_t link) {
  return link >= kLower ? (link - kLower) / 2 : link - kUpper;
}

std::vector<LinkInfo> Describe(const Delta& delta) {
  std::vector<LinkInfo> out(kDeltaTool + 1);
  const auto join = [&](std::size_t a, std::size_t b) {
    out[a].neighbours.push_back(b);
    out[b].neighbours.push_back(a);
  };
  for (std::size_t arm = 0; arm < 3; ++arm) {
    const std::string number = std::to_string(arm + 1);
    const std::size_t upper = kUpper + arm;
    out[upper].name = "upper_arm_" + number;
    out[upper].span = {delta.lengths.upper_arm, 0, 0};
    join(0, upper);
    const std::size_t rod = kLower + 2 * arm;
    for (const std::size_t side : {0u, 1u}) {
      out[rod + side].name = "lower_arm_" + number + (side == 0 ? "_a" : "_b");
      out[rod + side].span = {delta.lengths.lower_arm, 0, 0};
      join(upper, rod + side);
      join(rod + side, kPlatform);
    }
    join(rod, rod + 1);
  }
  out[kPlatform].name = "platform";
  join(kPlatform, kDeltaTool);
  return out;
}

Vector Tangent(const Delta& delta, std::size_t arm) {
  return {-delta.outward[arm].y(), delta.outward[arm].x(), 0};
}

Reason FramesOf(const Delta& delta, const Joints& joints, LinkFrameArray& out) {
  Frame tool;
  if (const Reason reason = Forward(delta, joints, tool); reason != Reason::kNone) return reason;
  if (!Finite(tool)) return Reason::kNotFinite;
  const DeltaLengths& l = delta.lengths;
  out[0] = Frame::Identity();
  for (std::size_t arm = 0; arm < 3; ++arm) {
    const Vector& outward = delta.outward[arm];
    const Vector tangent = Tangent(delta, arm);
    const KDL::Rotation level(outward, tangent, {0, 0, 1});
    Frame& upper = out[kUpper + arm];
    upper = Frame(level * AboutY(joints[arm]), outward * l.base_radius);
    const Vector knee = upper * Vector(l.upper_arm, 0, 0);
    const Vector along = (tool.p + outward * l.platform_radius - knee) / l.lower_arm;
    Vector side = tangent - along * dot(tangent, along);
    if (!(side.Normalize() > kSingularSine)) return Reason::kSingular;
    const KDL::Rotation turn(along, side, along * side);
    const Vector aside = tangent * (l.rod_spacing / 2);
    out[kLower + 2 * arm] = Frame(turn, knee + aside);
    out[kLower + 2 * arm + 1] = Frame(turn, knee - aside);
  }
  out[kPlatform] = Frame(tool.p);
  out[kDeltaTool] = tool;
  return Reason::kNone;
}

// The lower arms hold the platform: |platform - knee| is l for each, so with lower arms w, displacements e of the knees
// and d of the platform w·d = w·e - |d - e|²/2. With e known and the inverse of the rows w that bounds d by a quadratic
// equation; as the axes move monotonically, d begins at 0 and never exceeds its first root.
void Complete(const Delta& delta, const Joints&, const Joints&, Sweep& sweep) {
  const double length = delta.lengths.lower_arm;
  std::array<Vector, 3> w;
  double knee = 0;
  for (std::size_t arm = 0; arm < 3; ++arm) {
    w[arm] = sweep.start[kLower + 2 * arm].M.UnitX();
    knee = std::max(knee, delta.lengths.upper_arm * sweep.way[arm]);
  }
  const Vector a = w[1] * w[2];
  const Vector b = w[2] * w[0];
  const Vector c = w[0] * w[1];
  const double gain = (a.Norm() + b.Norm() + c.Norm()) / std::abs(dot(w[0], a));
  const double curve = gain / (2 * length);
  const double half = (1 - 2 * curve * knee) / 2;
  const double rest = gain * knee + curve * knee * knee;
  const double root = half * half - curve * rest;
  sweep.platform = half > 0 && root >= 0 ? rest / (half + std::sqrt(root)) : kUnknown;
}

// A rod moves with both of its ends; its frame turns with it, and about it so that Z stays across the arm's axis.
double MoveOfRod(const Delta& delta, const Sweep& sweep, std::size_t link, const Vector& point, double radius) {
  const double length = delta.lengths.lower_arm;
  const double knee = delta.lengths.upper_arm * sweep.way[ArmOf(link)];
  const double tilt = (knee + sweep.platform) / length;
  const Vector along = sweep.start[link].M.UnitX();
  const double sine = std::abs(dot(along, Tangent(delta, ArmOf(link)))) + tilt;
  if (!(tilt < 1 && sine < 1)) return kUnknown;
  const double turn = 2 * maths::Asin(tilt / 2) / std::sqrt((1 - sine) * (1 + sine));
  const double share = point.x() / length;
  const double aside = maths::Hypot(point.y(), point.z()) + radius;
  return std::abs(1 - share) * knee + std::abs(share) * sweep.platform + aside * turn;
}

double MoveInSpace(const Delta& delta, const Sweep& sweep, std::size_t link, const Vector& place, double radius) {
  if (link == 0) return 0;
  const Frame& frame = sweep.start[link];
  if (link >= kPlatform) {
    const double turn = link == kDeltaTool ? sweep.way[3] : 0;
    return sweep.platform + turn * (Distance(place, frame.p, {0, 0, 1}) + radius);
  }
  if (link >= kLower) return MoveOfRod(delta, sweep, link, frame.Inverse() * place, radius);
  return sweep.way[ArmOf(link)] * (Distance(place, frame.p, frame.M.UnitY()) + radius);
}

double MoveOf(const Delta& delta, const Sweep& sweep, std::size_t link, std::size_t seen_from, const Vector& point,
              double radius) {
  if (link == seen_from) return 0;
  const Vector place = sweep.start[link] * point;
  return MoveInSpace(delta, sweep, link, place, radius) + MoveInSpace(delta, sweep, seen_from, place, radius);
}

// --- All -----------------------------------------------------------------------------------------------------------

const Linear& Parts(const Linear& linear) {
  return linear;
}
const Delta& Parts(const Delta& delta) {
  return delta;
}
template <typename Arm>
const Chain& Parts(const Arm& arm) {
  return arm.chain;
}

}  // namespace

std::vector<LinkInfo> LinksOf(const Kinematics& k) {
  std::vector<LinkInfo> links = std::visit([](const auto& m) { return Describe(m); }, k.mechanism);
  links.front().name = kBase;
  links.back().name = kTool;
  return links;
}

Reason LinkFrames(const Kinematics& k, const Joints& joints, LinkFrameArray& out) noexcept {
  const Joints own = ToMechanism(k, joints);
  return std::visit([&](const auto& m) { return FramesOf(Parts(m), own, out); }, k.mechanism);
}

Reason MakeSweep(const Kinematics& k, const Joints& from, const Joints& to, Sweep& out) noexcept {
  const Joints own_from = ToMechanism(k, from);
  const Joints own_to = ToMechanism(k, to);
  out = {};
  for (std::size_t i = 0; i < k.count; ++i) out.way[i] = std::abs(own_to[i] - own_from[i]);
  return std::visit(
      [&](const auto& m) {
        const Reason reason = FramesOf(Parts(m), own_from, out.start);
        if (reason == Reason::kNone) Complete(Parts(m), own_from, own_to, out);
        return reason;
      },
      k.mechanism);
}

double DisplacementBound(const Kinematics& k, const Sweep& sweep, std::size_t link, std::size_t seen_from,
                         const KDL::Vector& point, double radius) noexcept {
  return std::visit([&](const auto& m) { return MoveOf(Parts(m), sweep, link, seen_from, point, radius); },
                    k.mechanism);
}

}  // namespace takt::kinematics
