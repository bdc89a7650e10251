// The tracks of a machine file, made without an engine: what takt track looks at.
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "takt/core/maths.h"
#include "takt/mover/track_network_state.h"
#include "takt/planar/clearance.h"
#include "takt/planar/nearest.h"
#include "takt/track/pending_edits.h"
#include "takt/track/ranges.h"

namespace takt::bindings {
namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using RangePair = py::typing::Tuple<double, double>;
using PlaceRow = py::typing::Tuple<double, double, double, double>;

class Layout {
 public:
  Layout(const py::bytes& text, const std::string& file_name)
      : machine_(*Load(text, file_name, false).machine),
        parts_(part::Make(machine_.coordinate_systems, machine_.parts)),
        tracks_(machine_.tracks, &parts_) {}

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const track::TrackParams& params : tracks_.params) names.push_back(params.name);
    return names;
  }
  double Length(std::size_t i) const { return tracks_.states.at(i).length; }
  bool Closed(std::size_t i) const { return tracks_.sketches.at(i).closed; }

  // mm; infinite where it is straight all the way.
  double SmallestRadius(std::size_t i) const {
    const planar::Track* way = tracks_.ways.at(i);
    const double curvature = way ? planar::PeakCurvature(*way, 0, way->length) : 0;
    return curvature > 0 ? 1 / curvature : std::numeric_limits<double>::infinity();
  }

  // Where it leads, in the coordinates of its part: x, y, direction in deg, curvature in 1/mm.
  PlaceRow At(std::size_t i, double s) const {
    const planar::TrackPoint point = planar::At(WayOf(i), s);
    return py::make_tuple(point.place.x, point.place.y, point.direction * 180 / std::numbers::pi, point.curvature);
  }
  double ClosestTo(std::size_t i, double x, double y) const {
    return planar::NearestTo(WayOf(i), planar::Place{x, y}).s;
  }
  // Number of its part, from 0; -1: none.
  int Part(std::size_t i) const {
    CheckTrack(i);
    return tracks_.part_of[i] == planar::kNoPart ? -1 : static_cast<int>(tracks_.part_of[i]);
  }
  // Each part is at this position, by its index from 1: as of there tracks are linked.
  void PlaceParts(const std::vector<std::uint32_t>& indices) {
    if (indices.size() != parts_.now.size()) throw std::invalid_argument("one position of each part");
    for (std::size_t k = 0; k < indices.size(); ++k) {
      if (indices[k] < 1 || indices[k] > parts_.all[k].positions.size()) throw std::out_of_range("no such position");
      parts_.now[k].position = parts_.now[k].commanded = indices[k] - 1;
    }
    track::MakeNodes(tracks_);
  }

  // Numbers of the tracks that end where it starts, or start where it ends.
  std::vector<std::size_t> Before(std::size_t i) const { return Meeting(tracks_.end_nodes, tracks_.start_nodes.at(i)); }
  std::vector<std::size_t> Behind(std::size_t i) const { return Meeting(tracks_.start_nodes, tracks_.end_nodes.at(i)); }

  RangePair Ranges(std::size_t i) const {
    CheckTrack(i);
    const track::CollisionRanges ranges = track::RangesOf(tracks_, i);
    return py::make_tuple(ranges.at_start, ranges.at_end);
  }

  // Returns the least gap [mm] from `least` on at which two movers of this size, both at the angle `turned` [deg],
  // clear each other everywhere on the track.
  double ClearGap(std::size_t i, double width, double height, double turned, double least) const {
    CheckTrack(i);
    const planar::Track* way = tracks_.ways[i];
    if (!way) return least;
    constexpr double kDegree = std::numbers::pi / 180;
    const planar::Footprint mover{width, height};
    const double length = tracks_.states[i].length, angle = turned * kDegree;
    for (const double at : {0.0, length}) {
      least = std::max(least, planar::ClearGap(mover, angle - planar::At(*way, at).direction));
    }
    return planar::ClearGapAlong(*way, mover, angle, 0, length, least);
  }

  // The ranges at both ends that movers keep to: as they are given, or as the engine finds them in passing.
  RangePair TrafficRanges(std::size_t i) {
    CheckTrack(i);
    const track::TrackParams& params = tracks_.params[i];
    if (params.collision_range_mode == track::CollisionRangeMode::kManual) {
      return py::make_tuple(params.collision_range_at_start, params.collision_range_at_end);
    }
    MakeStreets();
    return py::make_tuple(streets_->network.roads[i].range_at_start, streets_->network.roads[i].range_at_end);
  }

  // Returns for the start and the end the largest lead [mm] (planar::LeadAtStart) over the tracks that meet it there.
  RangePair Leads(std::size_t i) {
    CheckTrack(i);
    MakeStreets();
    const planar::Road& road = streets_->network.roads[i];
    return py::make_tuple(*std::ranges::max_element(road.leads_at_start), *std::ranges::max_element(road.leads_at_end));
  }

  // Rows of s, x, y, direction in deg, curvature in 1/mm, and 1 where a piece was given; `step` mm apart or nearer.
  Array Points(std::size_t i, double step) const {
    CheckTrack(i);
    const planar::Track* way = tracks_.ways[i];
    if (!(step > 0)) throw std::invalid_argument("step must be above 0");
    std::vector<double> rows;
    for (const planar::Piece& piece : way ? way->pieces : std::vector<planar::Piece>{}) {
      const double length = piece.segment.length;
      const double count = std::ceil(length / step);
      for (double k = 0; k <= count; ++k) {
        planar::TrackPoint point = planar::At(piece, length * k / count);
        point.place = point.place + tracks_.spot(i).origin;
        rows.insert(rows.end(), {piece.start + length * k / count, point.place.x, point.place.y,
                                 point.direction * 180 / std::numbers::pi, point.curvature, piece.given ? 1.0 : 0.0});
      }
    }
    constexpr py::ssize_t kColumns = 6;
    Array array({static_cast<py::ssize_t>(rows.size()) / kColumns, kColumns});
    std::copy(rows.begin(), rows.end(), array.mutable_data());
    return array;
  }

 private:
  // Computes the ranges and leads of all tracks, once.
  void MakeStreets() {
    if (streets_) return;
    streets_ = std::make_unique<mover::TrackNetworkState>(0, names());
    std::vector<mover::TrackView> now(tracks_.ways.size());
    for (std::size_t k = 0; k < now.size(); ++k) {
      const track::TrackParams& its = tracks_.params[k];
      now[k].way = tracks_.ways[k];
      now[k].length = tracks_.states[k].length;
      now[k].start_node = tracks_.start_nodes[k];
      now[k].end_node = tracks_.end_nodes[k];
      now[k].reach = maths::Hypot(its.mover_width, its.mover_height);
    }
    mover::Refresh(now, *streets_);
  }

  void CheckTrack(std::size_t i) const {
    if (i >= tracks_.ways.size()) throw std::out_of_range("no such track");
  }
  const planar::Track& WayOf(std::size_t i) const {
    CheckTrack(i);
    if (!tracks_.ways[i]) throw std::invalid_argument("the track has no geometry");
    return *tracks_.ways[i];
  }
  static std::vector<std::size_t> Meeting(const std::vector<std::uint32_t>& nodes, std::uint32_t node) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (nodes[i] == node) found.push_back(i);
    }
    return found;
  }

  engine::Machine machine_;
  planar::Parts parts_;
  track::Tracks tracks_;
  std::unique_ptr<mover::TrackNetworkState> streets_;  // made when it is asked for
};

}  // namespace

void BindTrack(py::module_& m) {
  using L = Layout;
  py::class_<L>(m, "TrackLayout", "The tracks of a machine file. Raises takt.ConfigError with every problem.")
      .def(py::init<const py::bytes&, const std::string&>(), py::arg("text"), py::arg("file_name"))
      .def_property_readonly("names", &L::names)
      .def("length", &L::Length, py::arg("track"))
      .def("closed", &L::Closed, py::arg("track"))
      .def("smallest_radius", &L::SmallestRadius, py::arg("track"))
      .def("at", &L::At, py::arg("track"), py::arg("s"))
      .def("closest_to", &L::ClosestTo, py::arg("track"), py::arg("x"), py::arg("y"))
      .def("part", &L::Part, py::arg("track"))
      .def("place_parts", &L::PlaceParts, py::arg("indices"))
      .def("before", &L::Before, py::arg("track"))
      .def("behind", &L::Behind, py::arg("track"))
      .def("collision_ranges", &L::Ranges, py::arg("track"))
      .def("traffic_ranges", &L::TrafficRanges, py::arg("track"))
      .def("leads", &L::Leads, py::arg("track"))
      .def("clear_gap", &L::ClearGap, py::arg("track"), py::arg("width"), py::arg("height"), py::arg("turned"),
           py::arg("least"))
      .def("points", &L::Points, py::arg("track"), py::arg("step"));
}

}  // namespace takt::bindings
