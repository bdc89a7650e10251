#include "takt/cam/build.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "takt/cam/joints.h"
#include "takt/cam/points.h"
#include "takt/cam/segments.h"
#include "takt/cam/tasks.h"
#include "takt/cam/text.h"

namespace takt::cam {

namespace {

constexpr std::size_t kMaxErrors = 20;
constexpr double kRounding = 1e-6;  // CheckJoints ignores a millionth of its scale: i.e. 1e-12 of the rounded values

class Builder {
 public:
  explicit Builder(const CamParams& params) : params_(params) {}

  Built Run() {
    if (params_.segments.empty()) {
      CheckPoints();
      if (good()) ConnectPoints();
    } else {
      CheckSegments();
      if (good()) ConnectSegments();
    }
    if (good()) CheckNumbers();
    if (good()) CheckJoints(joints_, scale_, built_.errors, built_.warnings);
    if (good()) built_.table.emplace(params_, begins_, curves_, end_);
    return std::move(built_);
  }

 private:
  bool good() const { return built_.errors.empty(); }

  void Error(std::string path, std::string message) {
    if (built_.errors.size() < kMaxErrors) built_.errors.push_back({std::move(path), std::move(message)});
  }

  static std::string PathOf(const char* list, std::size_t i, const char* field = "") {
    return std::string(list) + "[" + std::to_string(i) + "]" + field;
  }

  void CheckFinite(const std::string& path, double value) {
    if (!std::isfinite(value)) Error(path, "expected a finite number, found " + Text(value));
  }

  // The path of a row is only formatted if the row is wrong: there are many rows.
  void CheckPoints() {
    const std::vector<CamPoint>& points = params_.points;
    if (points.size() < kMinPoints || points.size() > kMaxPoints) {
      return Error("points", "expected 2 to 100,000 points, found " + std::to_string(points.size()));
    }
    const bool linear = params_.interpolation == Interpolation::kLinear;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CamPoint& p = points[i];
      if (!std::isfinite(p.x)) CheckFinite(PathOf("points", i, ".x"), p.x);
      if (!std::isfinite(p.y)) CheckFinite(PathOf("points", i, ".y"), p.y);
      if (p.v && !std::isfinite(*p.v)) CheckFinite(PathOf("points", i, ".v"), *p.v);
      if (p.a && !std::isfinite(*p.a)) CheckFinite(PathOf("points", i, ".a"), *p.a);
      if (i > 0 && p.x <= points[i - 1].x) {
        Error(PathOf("points", i, ".x"),
              "expected x above " + Text(points[i - 1].x) + " of the point before, found " + Text(p.x));
      }
      if (p.v && linear) Error(PathOf("points", i, ".v"), "expected no velocity in a linear cam, found " + Text(*p.v));
      if (p.a && params_.interpolation != Interpolation::kQuintic &&
          params_.interpolation != Interpolation::kMonotone) {
        Error(PathOf("points", i, ".a"),
              "expected no acceleration but in a quintic or monotone cam, found " + Text(*p.a));
      }
    }
  }

  void ConnectPoints() {
    const std::vector<CamPoint>& points = params_.points;
    for (const CamPoint& p : points) begins_.push_back(p.x);
    end_ = begins_.back();
    begins_.pop_back();
    curves_ = Interpolate(points, params_.interpolation, params_.cyclic);
    const bool linear = params_.interpolation == Interpolation::kLinear;
    // Other interpolations have no jumps inside.
    for (std::size_t i = 1; linear && i < curves_.size(); ++i) {
      const JointSide before{{points[i].y, curves_[i - 1].c[1], 0, 0}, true, true};
      joints_.push_back({PathOf("points", i), begins_[i], before, {{points[i].y, curves_[i].c[1], 0, 0}, true, true}});
    }
    if (params_.cyclic) AddSeam(PathOf("points", points.size() - 1), {linear, linear}, {linear, linear});
    if (!params_.cyclic || linear) return;
    // The curve's end equals its beginning, except for the acceleration of a spline whose velocity was given there, and
    // for values that were given twice.
    Value& end = joints_.back().before.value;
    const Value& beginning = joints_.back().behind.value;
    end.dy = points.back().v.value_or(beginning.dy);
    if (params_.interpolation != Interpolation::kCubicSpline) end.ddy = points.back().a.value_or(beginning.ddy);
  }

  struct Nature {
    bool straight = false;
    bool jumps = false;
  };
  static Nature NatureOf(const CamSegment& s) {
    const bool straight = s.law == Law::kDwell || s.law == Law::kLine;
    return {straight, JumpsInAcceleration(s.law, s.sine_share)};
  }

  void AddSeam(std::string path, Nature end, Nature beginning) {
    const Value last = ValueOf(curves_.back(), end_ - begins_.back());
    const Value first = ValueOf(curves_.front(), 0);
    joints_.push_back(
        {std::move(path), end_, {last, end.straight, end.jumps}, {first, beginning.straight, beginning.jumps}, true});
  }

  void CheckSegments() {
    if (params_.segments.size() > kMaxSegments) {
      return Error("segments", "expected 20,000 segments at most, found " + std::to_string(params_.segments.size()));
    }
    CamPlace before = params_.segments.front().from.value_or(CamPlace{});
    for (std::size_t i = 0; i < params_.segments.size(); ++i) {
      const CamSegment& s = params_.segments[i];
      CheckSegment(i, s, before);
      before = s.to;
    }
  }

  void CheckSegment(std::size_t i, const CamSegment& s, const CamPlace& before) {
    const CamPlace from = s.from.value_or(before);
    for (const auto& [field, value] : {std::pair(".from.x", from.x),
                                       {".from.y", from.y},
                                       {".to.x", s.to.x},
                                       {".to.y", s.to.y},
                                       {".begin_v", s.begin_v.value_or(0)},
                                       {".begin_a", s.begin_a.value_or(0)},
                                       {".end_v", s.end_v.value_or(0)},
                                       {".end_a", s.end_a.value_or(0)},
                                       {".sine_share", s.sine_share},
                                       {".cosine_share", s.cosine_share},
                                       {".inflection", s.inflection}}) {
      CheckFinite(PathOf("segments", i, field), value);
    }
    if (from.x != before.x) {
      Error(PathOf("segments", i, ".from.x"),
            "expected x " + Text(before.x) + " where the segment before ends, found " + Text(from.x));
    }
    if (s.to.x <= from.x) {
      Error(PathOf("segments", i, ".to.x"),
            "expected x above " + Text(from.x) + " of its beginning, found " + Text(s.to.x));
    }
    if (s.law == Law::kDwell && s.to.y != from.y) {
      Error(PathOf("segments", i, ".to.y"),
            "expected y " + Text(from.y) + " of its beginning in a dwell, found " + Text(s.to.y));
    }
    if (!ConnectsAny(s.law) && (s.begin_v || s.begin_a || s.end_v || s.end_a)) {
      Error(PathOf("segments", i, ".law"),
            "expected a law that takes velocities and accelerations where they are given (quintic, modified_sine, "
            "modified_trapezoid, cycloid, sine_constant_cosine, polynomial_345, polynomial_4567, polynomial_8, task, "
            "least_acceleration, least_jerk), found another law");
    }
  }

  void ConnectSegments() {
    const std::vector<CamSegment> segments = Completed(params_.segments, params_.cyclic);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const std::vector<SegmentPiece> pieces = PiecesOf(segments[i]);
      if (i > 0) {
        const Value before = ValueOf(curves_.back(), pieces.front().begin - begins_.back());
        const Value behind = ValueOf(pieces.front().curve, 0);
        const Nature left = NatureOf(segments[i - 1]), right = NatureOf(segments[i]);
        joints_.push_back({PathOf("segments", i),
                           pieces.front().begin,
                           {before, left.straight, left.jumps},
                           {behind, right.straight, right.jumps}});
      }
      for (const SegmentPiece& piece : pieces) {
        begins_.push_back(piece.begin);
        curves_.push_back(piece.curve);
      }
    }
    end_ = segments.back().to.x;
    if (params_.cyclic) {
      AddSeam(PathOf("segments", segments.size() - 1), NatureOf(segments.back()), NatureOf(segments.front()));
    }
  }

  // Values may be too far apart, or too close to one another, for the curve between them to be finite. Also collects
  // the scale of the cam.
  void CheckNumbers() {
    const double length = end_ - begins_.front();
    if (!std::isfinite(length) || !std::isfinite(100 * static_cast<double>(begins_.size()) / length)) {
      return Error("", "expected a length that a number can hold, found " + Text(length));
    }
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      const double end = i + 1 < begins_.size() ? begins_[i + 1] : end_;
      double sum = 0;
      for (const double share : {0.0, 0.5, 1.0}) {
        const Value value = ValueOf(curves_[i], share * (end - begins_[i]));
        Include(value, end - begins_[i]);
        sum += value.y + value.dy + value.ddy + value.dddy;
      }
      for (const double c : curves_[i].c) sum += c;
      if (std::isfinite(sum) && end > begins_[i]) continue;
      return Error("", "expected numbers that a curve can connect, found too little way or too much height from x " +
                           Text(begins_[i]) + " to " + Text(end));
    }
  }

  // The rounding of y over the length h counts as well.
  void Include(const Value& value, double h) {
    const double from_y = kRounding * std::abs(value.y) / h;
    const double from_dy = std::max(kRounding * std::abs(value.dy), from_y) / h;
    scale_.y = std::max(scale_.y, std::abs(value.y));
    scale_.dy = std::max({scale_.dy, std::abs(value.dy), from_y});
    scale_.ddy = std::max({scale_.ddy, std::abs(value.ddy), from_dy});
  }

  const CamParams& params_;
  std::vector<double> begins_;
  std::vector<Curve> curves_;
  double end_ = 0;
  Value scale_;  // largest magnitude of each
  std::vector<Joint> joints_;
  Built built_;
};

}  // namespace

Built Build(const CamParams& params) {
  return Builder(params).Run();
}

}  // namespace takt::cam
