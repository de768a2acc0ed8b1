#include "tools/validation/hidden/log_table.h"

#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace contour::hidden {

void WriteLogTable(const diagnosis::AxisLog& log, const std::filesystem::path& file) {
  if (log.missing > 0 || log.linear) throw std::runtime_error("this log does not fit into a plain table");
  const std::vector<std::pair<const char*, const std::vector<double>*>> all = {
      {"torque_Nm", &log.command},
      {"motor_angle_rad", &log.position},
      {"table_position_m", &log.table_position_m},
      {"temperature_degC", &log.temperature_degC},
      {"axis2_position_m", &log.axis2_position_m},
      {"reference_angle_rad", &log.reference_position}};
  std::string text = "time_s";
  std::vector<const std::vector<double>*> columns;
  for (const auto& [name, values] : all) {
    if (values->empty()) continue;
    columns.push_back(values);
    text += std::string(",") + name;
  }
  for (std::size_t k = 0; k < log.size(); ++k) {
    char number[40];
    std::snprintf(number, sizeof number, "\n%.9g", static_cast<double>(k) * log.period_s);
    text += number;
    for (const auto* column : columns) {
      // The shortest text that reads back to the same number.
      const auto end = std::to_chars(number, number + sizeof number, (*column)[k]).ptr;
      text += ',';
      text.append(number, end);
    }
  }
  text += '\n';
  std::FILE* out = std::fopen(file.c_str(), "wb");
  const bool written = out != nullptr && std::fwrite(text.data(), 1, text.size(), out) == text.size();
  if (out == nullptr || std::fclose(out) != 0 || !written)
    throw std::runtime_error("cannot write " + file.string());
}

}  // namespace contour::hidden
