#include "lab/core/map_params.h"

#include "lab/core/maps.h"

namespace gnomon {

Params mapParams(const Parameterization& map, const FittedMap& fitted, const MapOptions& options) {
  Params params;
  const auto tell = [&](const MapOption& option) {
    const std::string text = option.told(options);
    if (option.isNumber())
      params.push_back({option.name(), int64_t{std::stoll(text)}});
    else
      params.push_back({option.name(), text});
  };
  for (const MapOption* option : allMapOptions())
    if (option->results() == InResults::EveryRow) tell(*option);
  for (const MapOption* option : map.options())
    if (option->results() == InResults::OwnRows ||
        (option->results() == InResults::WhereChanged && options.find(*option) != nullptr))
      tell(*option);
  for (const auto& [name, text] : map.fitParams(fitted)) params.push_back({name, text});
  return params;
}

}  // namespace gnomon
