#include "takt/cam/joints.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "takt/cam/text.h"

namespace takt::cam {

namespace {

// Relative to the largest value in the cam: the residues of rounding and of decimals in a file.
constexpr double kSamePosition = 1e-9;
constexpr double kSameDerivative = 1e-6;

class Check {
 public:
  Check(std::span<const Joint> joints, const Value& scale, std::vector<Finding>& errors, std::vector<Finding>& warnings)
      : joints_(joints), scale_(scale), errors_(errors), warnings_(warnings) {}

  void Run() {
    for (const Joint& joint : joints_) Look(joint);
    if (!worst_) return;
    const Joint& w = *worst_;
    warnings_.push_back({w.path, "straight lines meet with a jump of velocity at " + std::to_string(jumps_) +
                                     (jumps_ == 1 ? " place" : " places") + ", the largest at x " + Text(w.x) +
                                     ", from " + Rounded(w.before.value.dy, scale_.dy) + " to " +
                                     Rounded(w.behind.value.dy, scale_.dy) +
                                     "; the slave follows there as its limits allow"});
  }

 private:
  static bool Differ(double a, double b, double tolerance) { return std::abs(a - b) > tolerance; }

  // Formats the significant digits.
  static std::string Rounded(double value, double scale) {
    if (std::abs(value) < 1e-9 * scale) return "0";
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), "%.9g", value);
    return Text(std::strtod(digits.data(), nullptr));
  }

  std::string Expected(const Joint& joint, const char* what, double before, double behind, double scale) const {
    const std::string whose =
        joint.seam ? " at the end of a cyclic cam as at its beginning, " : " of the segment before, ";
    const double wanted = joint.seam ? behind : before, found = joint.seam ? before : behind;
    return std::string("expected the ") + what + whose + Rounded(wanted, scale) + " at x " + Text(joint.x) +
           ", found " + Rounded(found, scale);
  }

  void Look(const Joint& joint) {
    const Value& a = joint.before.value;
    const Value& b = joint.behind.value;
    const bool lines = joint.before.straight && joint.behind.straight;
    if (!joint.seam && Differ(a.y, b.y, kSamePosition * scale_.y)) {
      (lines ? warnings_ : errors_).push_back({joint.path, Expected(joint, "position", a.y, b.y, scale_.y)});
    }
    if (Differ(a.dy, b.dy, kSameDerivative * scale_.dy)) {
      if (lines) {
        ++jumps_;
        if (!worst_ || JumpOf(joint) > JumpOf(*worst_)) worst_ = &joint;
      } else {
        errors_.push_back({joint.path, Expected(joint, "velocity", a.dy, b.dy, scale_.dy)});
      }
    } else if (Differ(a.ddy, b.ddy, kSameDerivative * scale_.ddy)) {
      const bool by_nature = joint.before.jumps || joint.behind.jumps;
      if (by_nature && !joint.seam) return;
      (joint.seam && !by_nature ? errors_ : warnings_)
          .push_back({joint.path, Expected(joint, "acceleration", a.ddy, b.ddy, scale_.ddy)});
    }
  }

  static double JumpOf(const Joint& joint) { return std::abs(joint.behind.value.dy - joint.before.value.dy); }

  std::span<const Joint> joints_;
  Value scale_;
  std::vector<Finding>& errors_;
  std::vector<Finding>& warnings_;
  std::size_t jumps_ = 0;  // of velocity, between straight lines
  const Joint* worst_ = nullptr;
};

}  // namespace

void CheckJoints(std::span<const Joint> joints, const Value& scale, std::vector<Finding>& errors,
                 std::vector<Finding>& warnings) {
  Check(joints, scale, errors, warnings).Run();
}

}  // namespace takt::cam
