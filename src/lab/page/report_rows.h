#pragma once
// Numbers and rows of a report as its template names them.

#include "lab/page/report_data.h"
#include "lab/page/report_pictures.h"

#include <string>

#include <kainjow/mustache.hpp>

namespace gnomon {

using View = kainjow::mustache::data;
// A name that the template asks for must be set in every item of a list: a missing one is looked up outside.
View viewList();

std::string grouped(uint64_t count);             // 93 863
std::string percent(double fraction);            // 0.0573 %
std::string shortNumber(double value);           // four digits
std::string kindTitle(const std::string& kind);  // "second_depth" -> "Second depth"; a filter may follow
bool isShaded(const std::string& kind);          // a picture with many shades, which JPEG suits

// The figures of these pictures: EXR data is left out. Shaded pictures become JPEG.
View pictureViews(const ReportPictures& pictures, ReportPictureShelf& shelf);

// Names of the <img>s that a row is held against; empty where there is none.
struct ExactPictures {
  std::string visibility, beauty;
};
struct RowContext {
  const ReportData& data;
  double barScale = 1.0;  // fraction of scored pixels that fills a bar
  const ExactPictures& exact;
};
// The `rank`th row (from 1).
View rowView(const ReportRow& row, size_t rank, const RowContext& context, ReportPictureShelf& shelf);

std::string rowId(size_t rank);  // "row-3"
// What tells this row from the others of the comparison: bias and filter, and with them the map.
std::string methodName(const ReportData& data, const ReportRow& row);
std::string rowName(const ReportData& data, const ReportRow& row);

}  // namespace gnomon
