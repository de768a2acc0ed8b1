#include "analysis/metrics/truth_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string_view>

namespace contour {
namespace {

// Both sides multiply the same count by the same factor; a count is larger than this for up to 26 bits.
constexpr double kSameAngle_rad = 5e-8;
constexpr std::size_t kProbes = 64;
constexpr double kNearlyAll = 0.95;

std::vector<std::string_view> Fields(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

/// Reads one line after the other into samples, by the places that the header names.
class TruthReader {
 public:
  TruthReader(const std::string& file, std::string_view header, std::span<const std::string> axes)
      : file_(file), header_(Fields(header)) {
    sync_ = Column("sync_number");
    free_running_ = Column("free_running");
    for (const std::string& axis : axes) {
      table_.push_back(Column(axis + "_table_position_m"));
      // Files of before it was written have none, and an absolute encoder.
      if (Has(axis + "_encoder_zero_m")) zero_.push_back(Column(axis + "_encoder_zero_m"));
      friction_.push_back(Column(axis + "_friction_N"));
      reported_.push_back(Column(axis + "_reported_position_rad"));
    }
    columns_ = header_.size();
    header_.clear();  // the text it points to goes
  }

  /// Empty for rows that belong to no SYNC.
  std::optional<TruthSample> Read(std::string_view line, std::size_t number) const {
    const auto fields = Fields(line);
    if (fields.size() != columns_) {
      throw std::runtime_error(file_ + ":" + std::to_string(number) + ": found " +
                               std::to_string(fields.size()) + " fields, expected " +
                               std::to_string(columns_));
    }
    const auto read = [&](std::size_t column, auto& value) {
      const std::string_view text = fields[column];
      if (std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc{}) {
        throw std::runtime_error(file_ + ":" + std::to_string(number) + ": found '" + std::string(text) +
                                 "', expected a number");
      }
    };
    TruthSample sample;
    int free_running = 0;
    read(sync_, sample.sync_number);
    read(free_running_, free_running);
    if (free_running != 0) return std::nullopt;
    const auto read_axes = [&](const std::vector<std::size_t>& columns, PerAxis<double>& values) {
      values.resize(columns.size());
      for (std::size_t i = 0; i < columns.size(); ++i) read(columns[i], values[i]);
    };
    read_axes(table_, sample.table_m);
    PerAxis<double> zero_m;
    read_axes(zero_, zero_m);
    for (std::size_t i = 0; i < zero_m.size(); ++i) sample.table_m[i] -= zero_m[i];
    read_axes(friction_, sample.friction_N);
    read_axes(reported_, sample.reported_rad);
    return sample;
  }

 private:
  [[nodiscard]] bool Has(std::string_view name) const {
    return std::find(header_.begin(), header_.end(), name) != header_.end();
  }
  std::size_t Column(const std::string& name) const {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found == header_.end()) throw std::runtime_error(file_ + ":1: column " + name + " is missing");
    return static_cast<std::size_t>(found - header_.begin());
  }

  std::string file_;
  std::vector<std::string_view> header_;
  std::size_t columns_ = 0;
  std::size_t sync_ = 0;
  std::size_t free_running_ = 0;
  std::vector<std::size_t> table_;
  std::vector<std::size_t> zero_;
  std::vector<std::size_t> friction_;
  std::vector<std::size_t> reported_;
};

bool Same(const PerAxis<double>& a, const PerAxis<double>& b) {
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    if (std::abs(a[i] - b[i]) > kSameAngle_rad) return false;
  }
  return true;
}

/// Some of the received rows, evenly spread over those in which the machine moved.
std::vector<ReceivedAngles> Probes(std::span<const ReceivedAngles> received) {
  std::vector<ReceivedAngles> moving;
  for (std::size_t i = 1; i < received.size(); ++i) {
    if (!Same(received[i].angle_rad, received[i - 1].angle_rad)) moving.push_back(received[i]);
  }
  if (moving.size() <= kProbes) return moving;
  std::vector<ReceivedAngles> probes;
  for (std::size_t i = 0; i < kProbes; ++i) probes.push_back(moving[i * moving.size() / kProbes]);
  return probes;
}

}  // namespace

TruthTable::TruthTable(std::vector<TruthSample> samples, std::size_t axes)
    : samples_(std::move(samples)), axes_(axes) {
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const TruthSample& a, const TruthSample& b) { return a.sync_number < b.sync_number; });
}

TruthTable TruthTable::Load(const std::filesystem::path& file, std::span<const std::string> axes) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) throw std::runtime_error(file.string() + ": cannot be read");
  const TruthReader reader(file.string(), line, axes);
  std::vector<TruthSample> samples;
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    // A line without its end is still being written.
    if (in.eof()) break;
    if (auto sample = reader.Read(line, number)) samples.push_back(*sample);
  }
  return {std::move(samples), axes.size()};
}

const TruthSample* TruthTable::Find(std::uint64_t sync_number) const {
  const auto found =
      std::lower_bound(samples_.begin(), samples_.end(), sync_number,
                       [](const TruthSample& s, std::uint64_t n) { return s.sync_number < n; });
  return found != samples_.end() && found->sync_number == sync_number ? &*found : nullptr;
}

bool TruthTable::Agrees(const ReceivedAngles& received, std::int64_t offset) const {
  const std::int64_t number = static_cast<std::int64_t>(received.feedback_sync) + offset;
  if (number < 0) return false;
  const TruthSample* sample = Find(static_cast<std::uint64_t>(number));
  return sample != nullptr && Same(sample->reported_rad, received.angle_rad);
}

bool TruthTable::Explains(std::span<const ReceivedAngles> received, std::int64_t offset) const {
  const auto agreeing = std::count_if(received.begin(), received.end(),
                                      [&](const ReceivedAngles& r) { return Agrees(r, offset); });
  return static_cast<double>(agreeing) >= kNearlyAll * static_cast<double>(received.size());
}

std::optional<std::int64_t> TruthTable::OffsetOf(std::span<const ReceivedAngles> received) const {
  const std::vector<ReceivedAngles> probes = Probes(received);
  if (probes.size() < kProbes / 4 || axes_ == 0) return std::nullopt;
  if (Explains(probes, 0)) return 0;
  std::vector<const TruthSample*> by_angle;
  for (const TruthSample& s : samples_) by_angle.push_back(&s);
  std::sort(by_angle.begin(), by_angle.end(), [](const TruthSample* a, const TruthSample* b) {
    return a->reported_rad[0] < b->reported_rad[0];
  });
  // Every sample with a probe's angles votes for the offset between the two numbers.
  std::map<std::int64_t, std::size_t> votes;
  for (const ReceivedAngles& probe : probes) {
    auto s = std::lower_bound(by_angle.begin(), by_angle.end(), probe.angle_rad[0] - kSameAngle_rad,
                              [](const TruthSample* a, double angle) { return a->reported_rad[0] < angle; });
    for (; s != by_angle.end() && (*s)->reported_rad[0] <= probe.angle_rad[0] + kSameAngle_rad; ++s) {
      if (!Same((*s)->reported_rad, probe.angle_rad)) continue;
      ++votes[static_cast<std::int64_t>((*s)->sync_number) - static_cast<std::int64_t>(probe.feedback_sync)];
    }
  }
  const auto best = std::max_element(votes.begin(), votes.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  if (best == votes.end() || !Explains(probes, best->first)) return std::nullopt;
  return best->first;
}

void AddTruth(const TruthSample& truth, ScoredRow& row) {
  for (std::size_t i = 0; i < row.axes.size() && i < truth.table_m.size(); ++i) {
    row.axes[i].table_m = truth.table_m[i];
    row.axes[i].friction_truth_N = truth.friction_N[i];
  }
}

}  // namespace contour
