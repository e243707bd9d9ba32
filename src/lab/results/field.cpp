#include "lab/results/field.h"

#include <fmt/format.h>

namespace gnomon {

std::string tableCell(const FieldNotes& notes, std::optional<double> value) {
  const TableColumn& column = notes.table;
  std::string text;
  if (value && notes.kind == NumberKind::Share)
    text = fmt::format("{:.{}f}%", 100.0 * *value, column.decimals);
  else if (value)
    text = fmt::format("{:.{}f}", *value, column.decimals);
  return fmt::format(" {:>{}}", text, column.width);
}

}  // namespace gnomon
