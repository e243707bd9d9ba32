#pragma once
// What the pages of a comparison and of a medium share: their head, the frame of a plot, pictures by kind.

#include "lab/page/report_plot.h"
#include "lab/page/report_rows.h"

namespace gnomon {

// Scene, camera, picture, device, program, command.
void setFacts(View& page, const ReportData& data);

// The notice of pictures that could not be read.
void setMissing(View& page, const ReportPictureShelf& shelf);

// Of an <img> with the picture of this kind, embedded now if it was not; empty where there is none.
std::string idOf(const ReportPictures& pictures, const char* kind, ReportPictureShelf& shelf);

std::string coordinate(double value);  // of an SVG
View tickView(const PlotTick& tick, double tickEnd, double labelY);

// Size, frame, ticks of both axes, the strip of errors of 0. `size`: "wide" or "narrow".
void setPlotFrame(View& view, const Plot& plot, const char* size);

}  // namespace gnomon
