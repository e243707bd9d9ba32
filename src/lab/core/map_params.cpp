#include "lab/core/map_params.h"

#include "lab/core/maps.h"

namespace gnomon {

std::vector<MapParam> mapParams(const Parameterization& map, const FittedMap& fitted, const MapOptions& options) {
  std::vector<MapParam> params;
  const auto tell = [&](const MapOption& option) {
    params.push_back({.name = option.name(), .text = option.told(options), .isNumber = option.isNumber()});
  };
  for (const MapOption* option : allMapOptions())
    if (option->results() == InResults::EveryRow) tell(*option);
  for (const MapOption* option : map.options())
    if (option->results() == InResults::OwnRows ||
        (option->results() == InResults::WhereChanged && options.find(*option) != nullptr))
      tell(*option);
  for (const MapParam& param : map.fitParams(fitted)) params.push_back(param);
  return params;
}

}  // namespace gnomon
