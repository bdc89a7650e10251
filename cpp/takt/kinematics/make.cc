#include <cmath>
#include <filesystem>

#include "takt/core/angle.h"
#include "takt/core/read_file.h"
#include "takt/kinematics/kinematics.h"

namespace takt::kinematics {
namespace {

MakeResult Refused(std::string path, std::string problem) {
  return {.kinematics = std::nullopt, .path = std::move(path), .problem = std::move(problem)};
}

void TakeKinds(const Chain& chain, Kinematics& k) {
  k.count = chain.count;
  for (std::size_t i = 0; i < chain.count; ++i) k.kinds[i] = chain.links[i].kind;
}

Kinematics Of(const Linear& linear) {
  Kinematics k{.mechanism = linear, .count = linear.count};
  for (std::size_t i = 0; i < linear.count; ++i) k.kinds[i] = linear.kinds[i];
  return k;
}

Kinematics Of(const ScaraParams& p) {
  const Scara scara = MakeScara(p.first_arm, p.second_arm, p.height);
  Kinematics k{.mechanism = scara};
  TakeKinds(scara.chain, k);
  return k;
}

Kinematics Of(const DeltaParams& p) {
  const DeltaLengths lengths{p.base_radius, p.platform_radius, p.upper_arm, p.lower_arm, p.rod_spacing};
  Kinematics k{.mechanism = MakeDelta(lengths, p.first_arm_deg * kDegree, p.rotary), .count = p.rotary ? 4u : 3u};
  k.kinds.fill(JointKind::kRotary);
  return k;
}

Kinematics Of(const SixAxisParams& p) {
  const SixAxis arm = MakeSixAxis({p.a1, p.a2, p.b, p.c1, p.c2, p.c3, p.c4});
  Kinematics k{.mechanism = arm};
  TakeKinds(arm.chain, k);
  return k;
}

// Limits in URDF are the mechanism's; they are converted with the zero and sense of the axis.
void TakeLimits(const UrdfChain& urdf, Kinematics& k) {
  for (std::size_t i = 0; i < k.count; ++i) {
    const JointScale& scale = k.scales[i];
    const JointLimits& limits = urdf.limits[i];
    JointRange range;
    if (limits.lower) range.lower = *limits.lower / scale.factor + scale.zero;
    if (limits.upper) range.upper = *limits.upper / scale.factor + scale.zero;
    if (scale.factor < 0) std::swap(range.lower, range.upper);
    k.ranges[i] = range;
  }
}

// Returns what is wrong; empty if nothing is.
std::string TakeScales(const std::vector<JointParams>& joints, Kinematics& k) {
  if (!joints.empty() && joints.size() != k.count) {
    return "expected one entry for each of the " + std::to_string(k.count) + " axes, found " +
           std::to_string(joints.size());
  }
  for (std::size_t i = 0; i < k.count; ++i) {
    const JointParams joint = joints.empty() ? JointParams{} : joints[i];
    const double unit = k.kinds[i] == JointKind::kRotary ? kDegree : 1;
    k.scales[i] = {joint.zero, joint.invert ? -unit : unit};
  }
  return {};
}

std::optional<std::string> TextOf(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = 64'000'000;
  std::string why;
  return ReadFile(path.string(), kMostBytes, why);
}

}  // namespace

bool IsUrdfText(std::string_view urdf) noexcept {
  const std::size_t first = urdf.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && urdf[first] == '<';
}

std::optional<Problem> CheckUrdfFile(std::string& text, std::string_view file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  ProblemList problems(file, 1);
  if (CheckBytes(text, problems)) return std::nullopt;
  return problems.problems().front();
}

MakeResult Make(const KinematicsParams& params, std::string_view folder) {
  const int mechanisms = params.gantry.has_value() + params.core_xy.has_value() + params.scara.has_value() +
                         params.delta.has_value() + params.six_axis.has_value() + params.serial.has_value();
  if (mechanisms != 1) {
    return Refused("", "expected exactly one of the keys gantry, core_xy, scara, delta, six_axis, serial, found " +
                           std::to_string(mechanisms));
  }
  Kinematics k;
  std::optional<UrdfChain> urdf;
  if (params.gantry) {
    k = Of(MakeGantry(params.gantry->axes));
  } else if (params.core_xy) {
    k = Of(MakeCoreXy(params.core_xy->with_z, params.core_xy->with_c));
  } else if (params.scara) {
    k = Of(*params.scara);
  } else if (params.delta) {
    k = Of(*params.delta);
  } else if (params.six_axis) {
    k = Of(*params.six_axis);
  } else {
    const std::string& given = params.serial->urdf;
    const bool inside = IsUrdfText(given);
    const std::filesystem::path path = std::filesystem::path(folder) / (inside ? "" : given);
    std::optional<std::string> text = inside ? given : TextOf(path);
    if (!text) return Refused("serial.urdf", "cannot read " + path.string());
    if (!inside) {
      if (const auto problem = CheckUrdfFile(*text, path.string())) return Refused("serial.urdf", problem->Text());
    }
    std::string why;
    urdf = ReadUrdf(*text, params.serial->base, params.serial->tip, why);
    if (!urdf) return Refused("serial", (inside ? "" : path.string() + ": ") + why);
    k.mechanism = Serial{urdf->chain, urdf->links, Recognise(urdf->chain)};
    TakeKinds(urdf->chain, k);
  }
  if (std::string why = TakeScales(params.joints, k); !why.empty()) return Refused("joints", std::move(why));
  if (urdf) TakeLimits(*urdf, k);
  return {.kinematics = k, .path = {}, .problem = {}};
}

}  // namespace takt::kinematics
