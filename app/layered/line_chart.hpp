// Line charts as SVG, for reports that need nothing else.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace app {

struct ChartLine {
  std::string name;
  std::vector<std::pair<double, double>> points;  ///< By x.
  std::string family;                             ///< Lines of a family share a colour.
  uint32_t dash = 0;                              ///< 0: solid; 1, 2: how members of a family are told apart.
};
struct Chart {
  std::string title, x_label, y_label;
  std::vector<ChartLine> lines;
  std::vector<double> x_ticks;  ///< Ascending; the last ends the axis.
};

/// One picture with the charts side by side, two a row. Both axes begin at 0. At most ten families.
std::string charts_svg(const std::vector<Chart>& charts);

}  // namespace app
