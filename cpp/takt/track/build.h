// Makes the tracks of a machine file, each after those that it starts from and ends at. Not for the cycle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "takt/planar/track.h"
#include "takt/track/params.h"

namespace takt::track {

struct Built {
  planar::Layout layout;
  std::optional<planar::Track> way;  // none: it has no length yet
};

struct BuildProblem {
  std::string path;  // which key is wrong, seen from the list of tracks: "[2].elements[0]"
  std::string message;
};

struct BuildResult {
  std::vector<Built> tracks;
  std::vector<BuildProblem> problems;
};

BuildResult Build(const std::vector<TrackParams>& params);

}  // namespace takt::track
