#include "tools/contour/circle_test_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/circle_test/circle_model.h"
#include "analysis/recording/csv_table.h"
#include "config/config_error.h"
#include "config/whole_file.h"
#include "config/yaml_writer.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {
namespace {

using diagnosis::CsvTable;
using diagnosis::NumberOf;

struct Options {
  std::string cycles;
  std::string measured;
  std::vector<std::string> table_columns;
  std::string machine;
  std::vector<std::string> axes;
  std::string out;
};

using Axes = std::array<CircleAxis, kCircleAxes>;

std::size_t ColumnOf(const CsvTable& table, const std::string& name) {
  const auto& header = table.header();
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end())
    throw ConfigError({table.file() + ":1: found no column " + name + ", expected one of this name"});
  return static_cast<std::size_t>(found - header.begin());
}

struct Recorded {
  std::vector<CircleRow> rows;
  std::vector<std::array<double, kCircleAxes>> table_m;  ///< where columns have it
};

struct AxisColumns {
  std::size_t position = 0, torque = 0, velocity = 0, table = 0;
};

Recorded ReadCycles(const Options& o, const Axes& axes) {
  const CsvTable table(o.cycles);
  const std::size_t time = ColumnOf(table, "time_s"), path = ColumnOf(table, "path_time_s");
  const bool scales = !o.table_columns.empty();
  std::array<AxisColumns, kCircleAxes> at;
  for (std::size_t i = 0; i < kCircleAxes; ++i) {
    const std::string& name = axes[i].name;
    at[i] = {ColumnOf(table, name + "_position_m"), ColumnOf(table, name + "_actual_torque_Nm"),
             ColumnOf(table, name + "_reference_velocity_m_s"),
             scales ? ColumnOf(table, o.table_columns[i]) : 0};
  }
  Recorded out;
  table.ForEachRow([&](std::size_t line, const std::vector<std::string_view>& fields) {
    const auto number = [&](std::size_t column) {
      return NumberOf(fields[column], table.file(), line, table.header()[column]);
    };
    if (!(number(path) >= 0.0)) return;
    CircleRow row;
    row.time_s = number(time);
    std::array<double, kCircleAxes> table_m{}, speed_m_s{};
    for (std::size_t i = 0; i < kCircleAxes; ++i) {
      row.motor_m[i] = number(at[i].position);
      row.force_N[i] = number(at[i].torque) * 2.0 * std::numbers::pi / axes[i].lead_m;
      speed_m_s[i] = number(at[i].velocity);
      if (scales) table_m[i] = number(at[i].table);
    }
    row.speed_m_s = std::hypot(speed_m_s[0], speed_m_s[1]);
    out.rows.push_back(row);
    out.table_m.push_back(table_m);
  });
  return out;
}

/// As ball bars export it.
std::vector<CirclePoint> ReadMeasured(const std::string& file) {
  const CsvTable table(file);
  const std::size_t angle = ColumnOf(table, "angle_deg"), deviation = ColumnOf(table, "deviation_um");
  std::vector<CirclePoint> points;
  table.ForEachRow([&](std::size_t line, const std::vector<std::string_view>& fields) {
    points.push_back({NumberOf(fields[angle], file, line, "angle_deg") * std::numbers::pi / 180.0,
                      1e-6 * NumberOf(fields[deviation], file, line, "deviation_um")});
  });
  return points;
}

std::string Digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}
std::string PlusMinus(double value, double std) { return Digits(value) + " +- " + Digits(std); }

void Say(const CircleTestResult& found, const Axes& axes) {
  for (std::size_t i = 0; i < kCircleAxes; ++i) {
    const CircleAxisFound& axis = found.axes[i];
    std::cout << "axis " << axes[i].name << ": share of friction before the screw "
              << PlusMinus(axis.motor_share.value, axis.motor_share.std);
    if (axis.wobble_seen)
      std::cout << ", wobble of the lead "
                << PlusMinus(1e6 * std::hypot(axis.wobble_sine.value, axis.wobble_cosine.value),
                             1e6 * std::max(axis.wobble_sine.std, axis.wobble_cosine.std))
                << " um\n";
    else
      std::cout << "; the circle is too small for a wobble of the lead\n";
  }
  std::cout << "the model left " << Digits(1e6 * found.before_m)
            << " um rms of the measured radius, with this " << Digits(1e6 * found.after_m) << " um\n";
}

void Write(const Options& o, const std::string& name, const ModelConfig& model) {
  const std::filesystem::path file = std::filesystem::path(o.out) / (name + ".yaml");
  WriteWholeFile(file, "# The model of axis " + name + " of " + o.machine +
                           ", with what a measured circle told.\n" + WriteYaml(model));
  std::cout << "wrote " << file.string() << "\n";
}

int RunCircleTest(const Options& o) {
  if (o.measured.empty() == o.table_columns.empty())
    throw ConfigError({"contour circle-test: expected either --measured FILE or --table-columns X Y"});
  const MachineConfig machine = LoadMaybeEmulatedMachine(o.machine).machine;
  Axes axes;
  for (std::size_t i = 0; i < kCircleAxes; ++i) {
    const auto found = machine.axes.find(o.axes[i]);
    if (found == machine.axes.end())
      throw ConfigError(
          {o.machine + ": axes." + o.axes[i] + ": missing, expected an axis of this name (--axes)"});
    axes[i] = CircleAxisOf(o.axes[i], found->second.model);
  }
  const Recorded recorded = ReadCycles(o, axes);
  const auto measured = [&] {
    if (!o.measured.empty()) return ReadMeasured(o.measured);
    const RowRange turns = TurnsOfCircle(recorded.rows);
    return RadiiOf({recorded.table_m.begin() + static_cast<std::ptrdiff_t>(turns.begin),
                    recorded.table_m.begin() + static_cast<std::ptrdiff_t>(turns.end)});
  };
  const CircleTestResult found = FitCircle(axes, recorded.rows, measured());
  Say(found, axes);
  if (const std::string wrong = WhatIsWrong(found, axes); !wrong.empty())
    throw std::runtime_error(wrong + "; nothing was written");
  std::filesystem::create_directories(o.out);
  for (std::size_t i = 0; i < kCircleAxes; ++i) {
    ModelConfig model = machine.axes.at(axes[i].name).model;
    IntoModel(found.axes[i], model);
    Write(o, axes[i].name, model);
  }
  return kExitDone;
}

}  // namespace

void AddCircleTestCommand(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  options->axes = {"x", "y"};
  CLI::App* sub = app.add_subcommand(
      "circle-test", "Friction before the screw and wobble of the lead, from one circle that was measured");
  sub->add_option("cycles", options->cycles, "cycles.csv of the circle (contour export, contour simulate)")
      ->required()
      ->check(CLI::ExistingFile);
  sub->add_option("--machine", options->machine, "Machine file that the circle was drawn with")
      ->required()
      ->check(CLI::ExistingFile);
  sub->add_option("--measured", options->measured,
                  "Table of a ball bar: angle_deg from the first axis towards the second, deviation_um")
      ->check(CLI::ExistingFile);
  sub->add_option("--table-columns", options->table_columns,
                  "Instead: columns of cycles.csv with the table's positions in m, of linear scales")
      ->expected(2);
  sub->add_option("--axes", options->axes, "The two axes")->expected(2)->capture_default_str();
  sub->add_option("--out", options->out, "Directory for a model file of each axis")->required();
  sub->callback([options, &action] { action = [options] { return RunCircleTest(*options); }; });
}

}  // namespace contour
