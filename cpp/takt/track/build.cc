#include "takt/track/build.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "takt/core/problem.h"
#include "takt/planar/crossing.h"
#include "takt/planar/network.h"
#include "takt/track/on_parts.h"
#include "takt/track/sketch.h"
#include "takt/track/state.h"

namespace takt::track {

namespace {

using planar::Problem;

std::string Index(std::size_t i) {
  return "[" + std::to_string(i) + "]";
}

class Builder {
 public:
  Builder(const std::vector<TrackParams>& params, const planar::Parts& parts)
      : params_(params), parts_(parts), marks_(params.size(), Mark::kNew) {
    result_.tracks.resize(params.size());
    for (const TrackParams& track : params) names_.push_back(track.name);
  }

  BuildResult Run() {
    for (std::size_t i = 0; i < params_.size(); ++i) Visit(i);
    if (result_.problems.empty()) CountAtPoints();
    return std::move(result_);
  }

 private:
  enum class Mark : std::uint8_t { kNew, kOpen, kDone, kFailed };

  bool Fail(const std::string& path, std::string message) {
    result_.problems.push_back({path, std::move(message)});
    return false;
  }
  bool Fail(const std::string& path, Problem problem) { return Fail(path, std::string(planar::Text(problem))); }

  // Returns false if the track cannot be built; then a problem says why.
  bool Visit(std::size_t i) {
    if (marks_[i] == Mark::kDone || marks_[i] == Mark::kFailed) return marks_[i] == Mark::kDone;
    marks_[i] = Mark::kOpen;
    open_.push_back(i);
    const bool made = Make(i);
    open_.pop_back();
    marks_[i] = made ? Mark::kDone : Mark::kFailed;
    return made;
  }

  // Checks that no more tracks start, or end, at one point than a network can link there, at any positions of the
  // parts.
  void CountAtPoints() {
    std::vector<std::size_t> points(2 * params_.size());  // starts, then ends
    for (std::size_t k = 0; k < points.size(); ++k) points[k] = k;
    const auto meet = [&](std::size_t a, std::size_t b) {
      const std::size_t other = points[b], own = points[a];
      std::ranges::replace(points, other, own);
    };
    const auto number = [&](const LinkParams& link) {
      return static_cast<std::size_t>(std::ranges::find(names_, link.track) - names_.begin());
    };
    const std::size_t count = params_.size();
    for (std::size_t i = 0; i < count; ++i) {
      const TrackParams& p = params_[i];
      for (const LinkParams& link : LinksOf(p.starts_from, p.starts_from_positions)) meet(i, count + number(link));
      for (const LinkParams& link : LinksOf(p.ends_at, p.ends_at_positions)) meet(count + i, number(link));
    }
    for (std::size_t i = 0; i < count; ++i) {
      const auto alike = [&](std::size_t from, std::size_t point) {
        const auto begin = points.begin() + static_cast<std::ptrdiff_t>(from);
        return std::count(begin, begin + static_cast<std::ptrdiff_t>(i) + 1, point);
      };
      const bool crowded = alike(0, points[i]) > std::ptrdiff_t{planar::kLinks} ||
                           alike(count, points[count + i]) > std::ptrdiff_t{planar::kLinks};
      if (crowded) Fail(Index(i), Problem::kTooMany);
    }
  }

  // Returns the key of a link: those with positions of parts follow the others, in a list of their own.
  static std::string KeyOf(const std::string& list, std::size_t names, std::size_t k) {
    return k < names ? list + Index(k) : list + "_positions" + Index(k - names) + ".track";
  }

  // Builds the listed tracks, and appends their ends, or starts, in the coordinates of the track's part. Returns false
  // if there is a problem; those of the listed tracks themselves are reported with them, not here.
  bool Others(const std::string& path, const std::vector<std::string>& names, const std::vector<LinkParams>& more,
              std::uint32_t part, bool ends, std::vector<planar::TrackPoint>& out) {
    const std::vector<LinkParams> links = LinksOf(names, more);
    bool good = true;
    if (links.size() > kLinks) good = Fail(path, Problem::kTooMany);
    for (std::size_t k = 0; k < links.size(); ++k) {
      const std::string place = KeyOf(path, names.size(), k);
      const std::string& name = links[k].track;
      const auto found = std::ranges::find(names_, name);
      if (found == names_.end()) {
        good = Fail(place, "expected the name of a track, found " + Quoted(name) + DidYouMean(name, names_));
        continue;
      }
      const auto before = names.begin() + static_cast<std::ptrdiff_t>(std::min(k, names.size()));
      if (k < names.size() && std::find(names.begin(), before, name) != before) {
        good = Fail(place, "expected each track once, found " + Quoted(name) + " again");
        continue;
      }
      const auto other = static_cast<std::size_t>(found - names_.begin());
      if (marks_[other] == Mark::kOpen) {
        good = Fail(place, "expected tracks that refer to one another in no circle, found " + CircleFrom(other));
      } else if (!Visit(other)) {
        good = false;
      } else if (!result_.tracks[other].way) {
        good = Fail(place, Problem::kOtherEmpty);
      } else if (params_[other].closed_loop) {
        good = Fail(place, Problem::kOtherClosed);
      } else {
        const planar::Track& way = *result_.tracks[other].way;
        planar::TrackPoint point = At(way, ends ? way.length : 0);
        const Problem apart = Meet(parts_, {PartOf(params_[other], parts_), links[k].other_position_index},
                                   {part, links[k].this_position_index}, point);
        if (apart != Problem::kNone) good = Fail(place, apart);
        out.push_back(point);
      }
    }
    return good;
  }

  std::string CircleFrom(std::size_t track) const {
    std::string text;
    for (auto at = std::ranges::find(open_, track); at != open_.end(); ++at) text += params_[*at].name + " -> ";
    return text + params_[track].name;
  }

  bool Make(std::size_t i) {
    const TrackParams& p = params_[i];
    const std::string path = Index(i);
    const std::uint32_t part = PartOf(p, parts_);
    if (!parts_.none() && part == planar::kNoPart) {
      return Fail(path + ".part", "expected the name of a part, found " + Quoted(p.part));
    }
    std::vector<planar::TrackPoint> before, behind;
    const bool starts = Others(path + ".starts_from", p.starts_from, p.starts_from_positions, part, true, before);
    const bool ends = Others(path + ".ends_at", p.ends_at, p.ends_at_positions, part, false, behind);
    if (p.elements.size() > kElements) return Fail(path + ".elements", Problem::kTooMany);
    if (!starts || !ends) return false;
    planar::Layout& layout = result_.tracks[i].layout;
    for (const ElementParams& element : p.elements) layout.elements.push_back(ToElement(element));
    layout.closed = p.closed_loop;
    if (!before.empty()) layout.from = before.front();
    if (!behind.empty()) layout.to = behind.front();
    for (std::size_t k = 1; k < before.size(); ++k) {
      const bool same = Same(*layout.from, before[k]);
      if (!same) return Fail(KeyOf(path + ".starts_from", p.starts_from.size(), k), Problem::kNotItsStart);
    }
    for (std::size_t k = 1; k < behind.size(); ++k) {
      const bool same = Same(*layout.to, behind[k]);
      if (!same) return Fail(KeyOf(path + ".ends_at", p.ends_at.size(), k), Problem::kNotItsEnd);
    }
    planar::Track way;
    const planar::Making making = MakeTrackWithoutCrossings(layout, way);
    if (making.problem == Problem::kNone) {
      if (!LiesOn(parts_, part, way)) return Fail(path, Problem::kOffPart);
      result_.tracks[i].way = std::move(way);
      return true;
    }
    const bool may_be_empty = !layout.closed && !layout.to;
    if (making.problem == Problem::kEmpty && may_be_empty) return true;
    return Fail(path + PlaceOf(making, p), std::string(planar::Text(making.problem)) + WhereItCrosses(making, layout));
  }

  static std::string WhereItCrosses(const planar::Making& making, const planar::Layout& layout) {
    planar::Track way;
    if (making.problem != Problem::kCrosses || planar::MakeTrack(layout, way).problem != Problem::kNone) return "";
    const std::optional<planar::Crossing> crossing = planar::SelfCrossing(way);
    if (!crossing) return "";
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), ", %.1f mm and %.1f mm along", crossing->first, crossing->second);
    return text.data();
  }

  // Returns the key at which a problem is reported.
  static std::string PlaceOf(const planar::Making& making, const TrackParams& p) {
    switch (making.problem) {
      case Problem::kEmpty:
      case Problem::kCrosses:
        return "";
      case Problem::kLinked:
        return ".closed_loop";
      default:
        break;
    }
    if (making.element < p.elements.size()) return ".elements" + Index(making.element);
    return p.closed_loop ? ".closed_loop" : KeyOf(".ends_at", p.ends_at.size(), 0);
  }

  const std::vector<TrackParams>& params_;
  const planar::Parts& parts_;
  std::vector<std::string_view> names_;
  std::vector<Mark> marks_;
  std::vector<std::size_t> open_;  // from the track first requested to the current one
  BuildResult result_;
};

}  // namespace

BuildResult Build(const std::vector<TrackParams>& params, const planar::Parts* parts) {
  return Builder(params, parts ? *parts : planar::Parts{}).Run();
}

std::uint32_t PartOf(const TrackParams& params, const planar::Parts& parts) {
  if (params.part.empty()) return parts.all.size() == 1 ? 0 : planar::kNoPart;
  const auto found = std::ranges::find(parts.all, params.part, &planar::Part::name);
  return found == parts.all.end() ? planar::kNoPart : static_cast<std::uint32_t>(found - parts.all.begin());
}

}  // namespace takt::track
