// Builds the tracks of a machine file, each after those that it starts from and ends at. Not for the cycle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "takt/planar/parts.h"
#include "takt/planar/track.h"
#include "takt/track/params.h"

namespace takt::track {

struct Built {
  planar::Layout layout;
  std::optional<planar::Track> way;  // none: it has no length yet
};

struct BuildProblem {
  std::string path;  // key with the problem, relative to the list of tracks: "[2].elements[0]"
  std::string message;
};

struct BuildResult {
  std::vector<Built> tracks;
  std::vector<BuildProblem> problems;
};

// Builds all tracks, on these parts in their current state; null: no parts.
BuildResult Build(const std::vector<TrackParams>& params, const planar::Parts* parts = nullptr);

// Returns the index of the part that a track lies on; kNoPart if there are no parts, or none of this name.
std::uint32_t PartOf(const TrackParams& params, const planar::Parts& parts);

}  // namespace takt::track
