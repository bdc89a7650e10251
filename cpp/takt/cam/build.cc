#include "takt/cam/build.h"

#include <algorithm>
#include <cmath>

#include "takt/cam/points.h"
#include "takt/core/scalar.h"

namespace takt::cam {

namespace {

constexpr std::size_t kMaxErrors = 20;

std::string Text(double value) {
  std::string text = std::isnan(value) ? "nan" : std::isinf(value) ? "inf" : FormatReal(value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

class Builder {
 public:
  explicit Builder(const CamParams& params) : params_(params) {}

  Built Run() {
    CheckPoints();
    if (built_.errors.empty()) MakeFromPoints();
    if (built_.errors.empty()) CheckJoints();
    if (built_.errors.empty()) built_.table.emplace(params_, begins_, curves_, end_);
    return std::move(built_);
  }

 private:
  void Error(std::string path, std::string message) {
    if (built_.errors.size() < kMaxErrors) built_.errors.push_back({std::move(path), std::move(message)});
  }

  static std::string PathOf(std::size_t i, const char* field) { return "points[" + std::to_string(i) + "]." + field; }

  void CheckPoints() {
    const std::vector<CamPoint>& points = params_.points;
    if (points.size() < kMinPoints || points.size() > kMaxPoints) {
      Error("points", "expected 2 to 100,000 points, found " + std::to_string(points.size()));
      return;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CamPoint& p = points[i];
      CheckFinite(i, "x", p.x);
      CheckFinite(i, "y", p.y);
      CheckFinite(i, "v", p.v.value_or(0));
      CheckFinite(i, "a", p.a.value_or(0));
      if (i > 0 && p.x <= points[i - 1].x) {
        Error(PathOf(i, "x"), "expected x above " + Text(points[i - 1].x) + " of the point before, found " + Text(p.x));
      }
      if (p.v && params_.interpolation == Interpolation::kLinear) {
        Error(PathOf(i, "v"), "expected no velocity in a linear cam, found " + Text(*p.v));
      }
      if (p.a && params_.interpolation != Interpolation::kQuintic) {
        Error(PathOf(i, "a"), "expected no acceleration but in a quintic cam, found " + Text(*p.a));
      }
    }
  }

  void CheckFinite(std::size_t i, const char* field, double value) {
    if (!std::isfinite(value)) Error(PathOf(i, field), "expected a finite number, found " + Text(value));
  }

  void MakeFromPoints() {
    for (const CamPoint& p : params_.points) begins_.push_back(p.x);
    end_ = begins_.back();
    begins_.pop_back();
    curves_ = Interpolate(params_.points, params_.interpolation, params_.cyclic);
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const double h = params_.points[i + 1].x - begins_[i];
      const Value end = ValueOf(curves_[i], h);
      if (std::isfinite(end.y) && std::isfinite(end.dddy) && std::isfinite(h)) continue;
      Error(PathOf(i + 1, "x"), "expected points that computers can connect, found a way of " + Text(h) + " to " +
                                    Text(params_.points[i + 1].y) + ", too short or too long for its height");
      return;
    }
  }

  void CheckJoints() {}

  const CamParams& params_;
  std::vector<double> begins_;
  std::vector<Curve> curves_;
  double end_ = 0;
  Built built_;
};

}  // namespace

Built Build(const CamParams& params) {
  return Builder(params).Run();
}

}  // namespace takt::cam
