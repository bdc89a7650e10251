// EN-37, EN-38: tables of cams and of paths as anyone may write them; what is read is built.
#include <cmath>
#include <cstdlib>
#include <string>

#include "takt/cam/build.h"
#include "takt/cam/csv.h"
#include "takt/group/path_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  takt::cam::CsvPoints points = takt::cam::ReadCsv(text, "cam.csv");
  if (points.problems.empty()) {
    takt::cam::CamParams cam;
    cam.points = std::move(points.points);
    takt::cam::Build(cam);
  }
  takt::group::PathCsv path = takt::group::ReadPathCsv(text, "path.csv");
  if (path.problems.empty()) {
    takt::group::PathParams params;
    params.elements = std::move(path.elements);
    takt::group::MakePathTable(params);
  }
  return 0;
}
