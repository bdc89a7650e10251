#include "takt/track/on_parts.h"

#include <algorithm>
#include <cmath>

namespace takt::track {

using planar::Problem;

std::optional<planar::Spot> SpotOf(const planar::Parts& parts, const Standing& standing) noexcept {
  if (standing.part == planar::kNoPart) return planar::Spot{};
  const planar::Part& part = parts.all[standing.part];
  if (standing.position > part.positions.size()) return std::nullopt;
  if (standing.position > 0) return part.positions[standing.position - 1];
  return parts.now[standing.part].away ? std::nullopt : std::optional(parts.spot(standing.part));
}

Problem Meet(const planar::Parts& parts, const Standing& other, const Standing& own,
             planar::TrackPoint& point) noexcept {
  if (other.part == own.part) return Problem::kNone;
  const std::optional<planar::Spot> from = SpotOf(parts, other), to = SpotOf(parts, own);
  if (!from || !to || from->system != to->system) return Problem::kApart;
  const bool ends = planar::IsOnBorder(parts.all[other.part], point.place);
  point.place = point.place + from->origin - to->origin;
  return ends && planar::IsOnBorder(parts.all[own.part], point.place) ? Problem::kNone : Problem::kNotOnBorder;
}

bool DoMeet(const planar::Parts& parts, std::uint32_t part_a, const planar::TrackPoint& a, std::uint32_t part_b,
            const planar::TrackPoint& b) noexcept {
  if (part_a == part_b) return true;
  if (part_a == planar::kNoPart || part_b == planar::kNoPart) return false;
  const planar::Spot &at_a = parts.goal(part_a), &at_b = parts.goal(part_b);
  return at_a.system == at_b.system && planar::SamePoint(a.place + at_a.origin, b.place + at_b.origin) &&
         planar::SameDirection(a, b) && planar::SameCurvature(a, b);
}

bool LiesOn(const planar::Parts& parts, std::uint32_t part, const planar::Track& track) {
  if (part == planar::kNoPart) return true;
  constexpr double kStride = 5;  // [mm] at the least radius a track deviates less than 2 mm between two samples
  const auto strides = static_cast<int>(std::ceil(track.length / kStride));
  for (int i = 0; i <= strides; ++i) {
    if (!planar::IsOn(parts.all[part], planar::At(track, track.length * i / strides).place)) return false;
  }
  return true;
}

}  // namespace takt::track
