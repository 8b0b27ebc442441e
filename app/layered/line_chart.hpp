// Line charts as SVG, for reports that need nothing else.
#pragma once
#include <string>
#include <vector>

namespace app {

struct ChartLine {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< By x.
};
struct Chart {
  std::string title, x_label, y_label;
  std::vector<ChartLine> lines;
};

/// One picture with the charts side by side, two a row. Both axes begin at 0.
std::string charts_svg(const std::vector<Chart>& charts);

}  // namespace app
