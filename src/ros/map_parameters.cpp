#include "map_parameters.h"

#include <string>

#include "casepush/common/input_error.h"

namespace casepush {
namespace {

MapOrigin mapOrigin(const std::string& source, const MapParameters& map) {
  if (!map.file.empty()) {
    if (!source.empty()) {
      throw InputError("map_source", "must be left out if map_file is given");
    }
    return MapOrigin::kFile;
  }
  if (source == "none" && !map.live_map) {
    throw InputError("map_source", "is none, which needs live_map: true");
  }
  return source == "map"    ? MapOrigin::kGrid
         : source == "none" ? MapOrigin::kNone
                            : MapOrigin::kSurvey;
}

}  // namespace

void readMapParameters(ParameterReader& reader, MapParameters& map) {
  reader.read("map_file", map.file);
  std::string source;
  reader.read("map_source", source, {"", "survey", "map", "none"});
  if (reader.has("map_resolution")) {
    map.resolution_m = map.resolution();
    reader.read("map_resolution", *map.resolution_m, 0.01, 0.5);
  }
  reader.read("occupancy/height", map.occupancy.height_m);
  reader.read("occupancy/occupied_from", map.occupancy.occupied_from, 1, 100);
  reader.read("occupancy/unknown_is_wall", map.occupancy.unknown_is_wall);
  reader.read("live_map", map.live_map);
  reader.read("live/rate", map.live_rate_hz, 0.1, 100.0);
  reader.read("live/max_delay", map.live_max_delay_s, 0.01, 60.0);
  reader.read("live/publish_period", map.live_publish_period_s, 0.1, 3600.0);
  reader.read("live/max_range", map.live.max_range_m);
  reader.read("live/ceiling", map.live.ceiling_m);
  reader.read("live/object_margin", map.live.object_margin_m);
  reader.read("live/robot_margin", map.live.robot_margin_m);
  reader.read("live/memory", map.live.memory_s);
  reader.check([&] {
    map.source = mapOrigin(source, map);
    map.occupancy.validate();
    map.live.validate();
  });
}

}  // namespace casepush
