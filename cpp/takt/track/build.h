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
  std::optional<planar::Track> way;  // none: no elements yet, or a problem
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

// Returns the index, from 0, of the part that a track lies on: of this name, or the only one if no name is given.
// kNoPart: there are no parts, none of this name, or several and no name.
std::uint32_t PartOf(const TrackParams& params, const planar::Parts& parts);

}  // namespace takt::track
