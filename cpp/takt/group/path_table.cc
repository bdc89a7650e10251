#include "takt/group/path_table.h"

#include <utility>

#include "takt/path/make.h"
#include "takt/path/spline.h"

namespace takt::group {

namespace {

// A pose with an optional orientation.
struct Station {
  kinematics::Pose pose;
  bool turned = false;
};

path::Point ToPoint(const Station& station) {
  kinematics::Pose pose = station.pose;
  if (!station.turned) pose.a = pose.b = pose.c = 0;
  return {kinematics::ToFrame(pose), {}};
}

class TableMaker {
 public:
  explicit TableMaker(const PathParams& params) : params_(params) {}

  PathTableResult Run() {
    PathTable table{params_.name, {}};
    for (std::size_t i = 0; i < params_.elements.size(); ++i) {
      const std::string path = "elements[" + std::to_string(i) + "]";
      if (!Add(params_.elements[i], path, table.pieces)) return {std::nullopt, path_, problem_};
    }
    return {std::move(table), {}, {}};
  }

 private:
  bool Fail(std::string path, std::string problem) {
    path_ = std::move(path);
    problem_ = std::move(problem);
    return false;
  }

  bool Add(const PathElement& element, const std::string& path, std::vector<PathPiece>& pieces) {
    if (element.shape == ElementShape::kSpline) return AddSpline(element, path, pieces);
    PathPiece piece{.shape = element.shape, .velocity = element.velocity.value_or(0)};
    if (element.shape == ElementShape::kArc) {
      piece.via = {element.via_x.value(), element.via_y.value(), element.via_z.value()};
    }
    Station to;
    if (!Follow(element.to.value(), path + ".to", to)) return false;
    if (at_ && !CanBeGone(piece, *at_, to, path)) return false;
    piece.to = to.pose;
    piece.turned = to.turned;
    pieces.push_back(piece);
    at_ = to;
    return true;
  }

  // The start of the first element is known only from a command.
  bool CanBeGone(const PathPiece& piece, Station from, const Station& to, const std::string& path) {
    if (!to.turned) from.turned = false;
    path::Segment segment;
    const path::Circle circle{.mode = path::CircMode::kBorder, .auxiliary_point = piece.via};
    const path::Problem problem = piece.shape == ElementShape::kArc
                                      ? path::MakeArc(ToPoint(from), circle, ToPoint(to), segment)
                                      : path::MakeLine(ToPoint(from), ToPoint(to), segment);
    return problem == path::Problem::kNone || Fail(path, std::string(path::Text(problem)));
  }

  bool AddSpline(const PathElement& element, const std::string& path, std::vector<PathPiece>& pieces) {
    std::vector<Station> stations;
    if (at_) stations.push_back(*at_);
    for (std::size_t i = 0; i < element.points.size(); ++i) {
      const bool first = stations.empty();
      Station station;
      if (!Follow(element.points[i], path + ".points[" + std::to_string(i) + "]", station)) return false;
      if (!first && station.turned != stations.front().turned) {
        return Fail(path + ".points[" + std::to_string(i) + "]",
                    "expected no a, b and c, since there are none where the spline begins");
      }
      stations.push_back(station);
      at_ = station;
    }
    std::vector<path::Point> points;
    for (const Station& station : stations) points.push_back(ToPoint(station));
    std::vector<path::Segment> segments;
    const path::Problem problem = path::MakeSpline(points, {}, segments);
    if (problem != path::Problem::kNone) return Fail(path + ".points", std::string(path::Text(problem)));
    for (std::size_t i = 0; i < segments.size(); ++i) {
      pieces.push_back({.shape = ElementShape::kSpline,
                        .to = stations[i + 1].pose,
                        .turned = stations[i + 1].turned,
                        .segment = segments[i],
                        .velocity = element.velocity.value_or(0)});
    }
    return true;
  }

  // Missing orientation values are as before; in the first orientation all three are needed.
  bool Follow(const PathPose& pose, const std::string& path, Station& to) {
    const bool before = at_ && at_->turned;
    const bool any = pose.a || pose.b || pose.c;
    if (any && !before && !(pose.a && pose.b && pose.c)) {
      return Fail(path, "expected a, b and c, or none of them, since no orientation was given before");
    }
    const kinematics::Pose old = before ? at_->pose : kinematics::Pose{};
    to = {{pose.x, pose.y, pose.z, pose.a.value_or(old.a), pose.b.value_or(old.b), pose.c.value_or(old.c)},
          before || any};
    return true;
  }

  const PathParams& params_;
  std::optional<Station> at_;  // end of the previous element
  std::string path_, problem_;
};

}  // namespace

PathTableResult MakePathTable(const PathParams& params) {
  return TableMaker(params).Run();
}

}  // namespace takt::group
