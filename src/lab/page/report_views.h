#pragma once
// What the pages of a comparison and of a medium share: their head, declared columns, the frame of a plot, pictures by
// kind.

#include "lab/page/report_pictures.h"
#include "lab/page/report_plot.h"
#include "lab/results/head.h"

#include <kainjow/mustache.hpp>

namespace gnomon {

using TemplateData = kainjow::mustache::data;
// A name that the template asks for must be set in every item of a list: a missing one is looked up outside.
TemplateData viewList();

// Scene, camera, picture, device, program, command.
void setFacts(TemplateData& page, const ResultsHead& head);

// The notice of pictures that could not be read.
void setMissing(TemplateData& page, const ReportPictureShelf& shelf);

std::string rowId(size_t rank);  // "row-3"

// Of a declared column its head, and of one row its cell.
TemplateData columnHead(const FieldNotes& notes);
TemplateData columnCell(const FieldNotes& notes, const std::optional<double>& value);

// The columns that the page has of these rows: those that are declared with a title, and not empty.
template <Record R>
class PageColumns {
 public:
  explicit PageColumns(const std::vector<R>& rows) {
    for (NumberField<R>& field : numberFields<R>())
      if (field.notes.title[0] != 0 && (field.notes.hides == Hides::Never || isInAny(field, rows)))
        columns_.push_back(std::move(field));
  }
  TemplateData heads() const {
    TemplateData list = viewList();
    for (const NumberField<R>& column : columns_) list.push_back(columnHead(column.notes));
    return list;
  }
  TemplateData cells(const R& row) const {
    TemplateData list = viewList();
    for (const NumberField<R>& column : columns_) list.push_back(columnCell(column.notes, column.of(row)));
    return list;
  }

 private:
  std::vector<NumberField<R>> columns_;
};

// The figures of these pictures: EXR data is left out. Shaded pictures become JPEG.
TemplateData pictureViews(const Pictures& pictures, ReportPictureShelf& shelf);

// Of an <img> with the picture of this kind, embedded now if it was not; empty where there is none.
std::string idOf(const Pictures& pictures, const char* kind, ReportPictureShelf& shelf);

std::string coordinate(double value);  // of an SVG
TemplateData tickView(const PlotTick& tick, double tickEnd, double labelY);

// Size, frame, ticks of both axes, the strip of errors of 0. `size`: "wide" or "narrow".
void setPlotFrame(TemplateData& view, const Plot& plot, const char* size);

}  // namespace gnomon
