#include "tools/plant_emulator/truth_writer.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace contour {
namespace {

constexpr std::size_t kBuffer = 64 * 1024;
constexpr std::size_t kLongestField = 40;

constexpr std::array kNumbers{
    &AxisTruth::motor_position_m,   &AxisTruth::motor_velocity_m_s, &AxisTruth::table_position_m,
    &AxisTruth::table_velocity_m_s, &AxisTruth::friction_N,         &AxisTruth::bristle_N,
    &AxisTruth::torque_Nm,          &AxisTruth::command_Nm,         &AxisTruth::reported_position_rad,
    &AxisTruth::encoder_zero_m,     &AxisTruth::temperature_degC};
constexpr std::array<std::string_view, kNumbers.size()> kNames{
    "motor_position_m", "motor_velocity_m_s", "table_position_m", "table_velocity_m_s",    "friction_N",
    "bristle_N",        "torque_Nm",          "command_Nm",       "reported_position_rad", "encoder_zero_m",
    "temperature_degC"};

}  // namespace

TruthWriter::TruthWriter(const std::string& path, std::vector<std::string> axis_names)
    : file_(std::fopen(path.c_str(), "w")), buffer_(kBuffer), axes_(axis_names.size()) {
  if (file_ == nullptr) throw std::runtime_error(path + ": cannot be written: " + std::strerror(errno));
  std::string header = "sync_number,time_s,free_running";
  for (const std::string& axis : axis_names) {
    for (const std::string_view name : kNames) header.append(",").append(axis).append("_").append(name);
    header.append(",").append(axis).append("_drive_state");
  }
  header.append("\n");
  Put(header.data(), header.size());
  Flush();
}

TruthWriter::~TruthWriter() { Flush(); }

void TruthWriter::Put(const char* text, std::size_t length) noexcept {
  if (used_ + length > buffer_.size()) Flush();
  if (length > buffer_.size()) return;
  std::memcpy(buffer_.data() + used_, text, length);
  used_ += length;
}

void TruthWriter::Put(double value) noexcept {
  if (used_ + kLongestField > buffer_.size()) Flush();
  buffer_[used_++] = ',';
  const auto [end, error] = std::to_chars(buffer_.data() + used_, buffer_.data() + buffer_.size(), value);
  if (error == std::errc{}) used_ = static_cast<std::size_t>(end - buffer_.data());
}

void TruthWriter::OnTruth(const TruthRow& row) noexcept {
  if (used_ + kLongestField > buffer_.size()) Flush();
  const auto [end, error] =
      std::to_chars(buffer_.data() + used_, buffer_.data() + buffer_.size(), row.sync_number);
  if (error == std::errc{}) used_ = static_cast<std::size_t>(end - buffer_.data());
  Put(row.time_s);
  Put(row.free_running ? ",1" : ",0", 2);
  for (std::size_t a = 0; a < axes_ && a < row.axes.size(); ++a) {
    for (const auto field : kNumbers) Put(row.axes[a].*field);
    const std::string_view state = Name(row.axes[a].drive_state);
    Put(",", 1);
    Put(state.data(), state.size());
  }
  Put("\n", 1);
}

void TruthWriter::Flush() noexcept {
  if (used_ == 0) return;
  if (ok() && (std::fwrite(buffer_.data(), 1, used_, file_.get()) != used_ || std::fflush(file_.get()) != 0))
    error_ = errno;
  used_ = 0;
}

}  // namespace contour
