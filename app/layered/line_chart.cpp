// Axes with round steps, a colour a line, the legend below the plots.
#include "layered/line_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace app {

namespace {
constexpr double kWidth = 460, kHeight = 300, kLeft = 62, kRight = 16, kTop = 34, kBottom = 44, kLegendRow = 18,
                 kTickDistance = 14;
constexpr std::array<const char*, 10> kColors{"#1f5fbf", "#c8322b", "#e38a1d", "#2c8a3d", "#7a4fb0",
                                              "#1a9aa0", "#8a6d3b", "#555555", "#d0609f", "#9aa51d"};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::string text_at(double x, double y, const std::string& text, const char* more) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + more + ">" + escaped(text) + "</text>\n";
}

/// 1, 2 or 5 times a power of ten, so that about five steps reach `most`.
double round_step(double most) {
  const double rough = std::max(most, 1e-9) / 5, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

struct Scale {
  double most = 1, step = 1;
  explicit Scale(double largest) : step(round_step(largest)) {
    most = std::max(step, step * std::ceil(largest / step));
  }
};

/// Of a line and of its sample in the legend.
std::string stroke(const std::string& color, uint32_t dash) {
  constexpr std::array<const char*, 3> kDashes{"", " stroke-dasharray=\"7 3\"", " stroke-dasharray=\"2 3\""};
  return " stroke=\"" + color + "\" stroke-width=\"1.8\"" + kDashes[std::min<size_t>(dash, kDashes.size() - 1)];
}

std::string chart_svg(const Chart& chart, double left, double top, const std::map<std::string, const char*>& colors) {
  double largest_y = 0;
  for (const ChartLine& line : chart.lines)
    for (const auto& [x, y] : line.points) largest_y = std::max(largest_y, y);
  const Scale y_scale(largest_y);
  const double most_x = chart.x_ticks.empty() ? 1 : chart.x_ticks.back();
  const double width = kWidth - kLeft - kRight, height = kHeight - kTop - kBottom;
  const auto at_x = [&](double x) { return left + kLeft + width * x / most_x; };
  const auto at_y = [&](double y) { return top + kTop + height * (1 - y / y_scale.most); };
  std::string out =
      text_at(left + kLeft + width / 2, top + 20, chart.title, "text-anchor=\"middle\" font-weight=\"bold\"");
  for (double y = 0; y <= y_scale.most * 1.0001; y += y_scale.step) {
    out += "<line x1=\"" + number(at_x(0)) + "\" x2=\"" + number(at_x(most_x)) + "\" y1=\"" + number(at_y(y)) +
           "\" y2=\"" + number(at_y(y)) + "\" stroke=\"#ddd\"/>\n";
    out += text_at(at_x(0) - 6, at_y(y) + 4, number(y), "text-anchor=\"end\"");
  }
  for (double last = 0; const double x : chart.x_ticks) {
    if (last > 0 && at_x(x) - at_x(last) < kTickDistance) continue;
    out += text_at(at_x(x), at_y(0) + 16, number(x), "text-anchor=\"middle\"");
    last = x;
  }
  out += text_at(left + kLeft + width / 2, top + kHeight - 10, chart.x_label, "text-anchor=\"middle\"");
  const std::string turned = "text-anchor=\"middle\" transform=\"rotate(-90 " + number(left + 14) + " " +
                             number(top + kTop + height / 2) + ")\"";
  out += text_at(left + 14, top + kTop + height / 2, chart.y_label, turned.c_str());
  for (const ChartLine& line : chart.lines) {
    const std::string color = colors.at(line.family);
    std::string points, dots;
    for (const auto& [x, y] : line.points) {
      points += number(at_x(x)) + "," + number(at_y(y)) + " ";
      dots +=
          "<circle cx=\"" + number(at_x(x)) + "\" cy=\"" + number(at_y(y)) + "\" r=\"2.4\" fill=\"" + color + "\"/>\n";
    }
    out += "<polyline fill=\"none\"" + stroke(color, line.dash) + " points=\"" + points + "\"/>\n" + dots;
  }
  return out;
}
}  // namespace

std::string charts_svg(const std::vector<Chart>& charts) {
  std::map<std::string, const char*> colors;
  std::vector<const ChartLine*> named;
  for (const Chart& chart : charts)
    for (const ChartLine& line : chart.lines) {
      colors.try_emplace(line.family, kColors[colors.size() % kColors.size()]);
      const auto is_it = [&](const ChartLine* known) { return known->name == line.name; };
      if (std::none_of(named.begin(), named.end(), is_it)) named.push_back(&line);
    }
  const size_t columns = charts.size() > 1 ? 2 : 1, rows = (charts.size() + columns - 1) / columns;
  constexpr size_t kNamesARow = 4;
  const double width = kWidth * static_cast<double>(columns), plots = kHeight * static_cast<double>(rows);
  const double height = plots + 10 + kLegendRow * static_cast<double>((named.size() + kNamesARow - 1) / kNamesARow);
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(width) + "\" height=\"" + number(height) +
      "\" viewBox=\"0 0 " + number(width) + " " + number(height) +
      "\" font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
  for (size_t i = 0; i < charts.size(); ++i)
    out += chart_svg(charts[i], kWidth * static_cast<double>(i % columns), kHeight * static_cast<double>(i / columns),
                     colors);
  for (size_t i = 0; i < named.size(); ++i) {
    const double x = 20 + (width - 40) / kNamesARow * static_cast<double>(i % kNamesARow);
    const double y = plots + 8 + kLegendRow * static_cast<double>(i / kNamesARow);
    out += "<path d=\"M" + number(x) + " " + number(y - 1) + "h20\"" +
           stroke(colors[named[i]->family], named[i]->dash) + "/>\n";
    out += text_at(x + 26, y + 3, named[i]->name, "");
  }
  return out + "</svg>\n";
}

}  // namespace app
