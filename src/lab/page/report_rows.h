#pragma once
// Formats the rows of a comparison for the page's template.

#include "lab/page/report_views.h"
#include "lab/results/comparison.h"

namespace gnomon {

// Names of the <img>s that a row is held against; empty where there is none.
struct ExactPictures {
  std::string visibility, beauty;
};
struct RowContext {
  const Comparison& data;
  const PageColumns<Row>& columns;
  std::string rank;       // as it is shown
  double barScale = 1.0;  // fraction of scored pixels that fills a bar
  std::string crown;      // "best tuned" and the like
  const ExactPictures& exact;
};
// The `number`th row (from 1).
TemplateData rowView(const Row& row, size_t number, const RowContext& context, ReportPictureShelf& shelf);

// What tells this row from the others of the comparison: bias and filter, and with them the map.
std::string methodName(const Comparison& data, const Row& row);
std::string rowName(const Comparison& data, const Row& row);

}  // namespace gnomon
