#pragma once
// Positions of the marks in the report's plot: cost to the right (linear or logarithmic), error upwards (logarithmic,
// with a separate strip for 0 below). In the units of an SVG's viewBox, y down.
//
//   10% -|        o none
//        |
//  0.1% -|   *---+
//        |       * dual          * is beaten by nothing that is also cheaper
//     0 =|___________*__________
//          15      20   ms

#include <string>
#include <vector>

namespace gnomon {

struct PlotItem {
  std::string label;
  double costMs = 0.0;
  double error = 0.0;  // fraction, at least 0
};

struct PlotMark {
  double x = 0.0, y = 0.0;
  bool onFront = false;   // no item is both cheaper and better, beyond noise
  bool labelled = false;  // its label has room; else it shows on focus and hover only
  double labelX = 0.0, labelY = 0.0;
  const char* anchor = "start";  // of the label, as in SVG
};

struct PlotTick {
  double at = 0.0;
  std::string text;
};

enum class CostAxis { Linear, Logarithmic };
enum class ErrorText { Percent, Number };

struct Plot {
  double width = 0.0, height = 0.0;
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;  // of the frame
  std::vector<PlotTick> costTicks, errorTicks;
  double zeroAt = 0.0;  // y of error 0
  bool hasZero = false;
  std::vector<PlotMark> marks;  // as the items
  std::string frontPath;        // SVG path through the front, cheapest first; empty for fewer than two
  double xOfCost(double costMs) const;
  double yOfError(double error) const;
  double errorBottom = 0.0;                  // y of the lowest decade; of the highest it is `top`
  int lowestDecade = -1, highestDecade = 0;  // of the error, powers of ten
  double costFrom = 0.0, costTo = 1.0;       // ms at the frame's sides
  CostAxis costAxis = CostAxis::Linear;
};

// On a logarithmic axis every cost is more than 0. Costs that differ by less than `costNoise` of the larger one are not
// told apart: of two such items the better one is on the front, and of equal ones both.
Plot layOutPlot(const std::vector<PlotItem>& items, double width, double height, CostAxis costAxis = CostAxis::Linear,
                ErrorText errorText = ErrorText::Percent, double costNoise = 0.0);

// Round steps of 1, 2 or 5 times a power of ten: about `count` numbers within [from, to].
std::vector<double> roundSteps(double from, double to, int count);

// 1, 2 and 5 times the powers of ten within [from, to], from > 0; the powers alone where that is more than `most`.
std::vector<double> decadeSteps(double from, double to, size_t most);

}  // namespace gnomon
