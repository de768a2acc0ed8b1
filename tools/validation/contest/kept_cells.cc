#include "tools/validation/contest/kept_cells.h"

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <stdexcept>

namespace contour {
namespace {

constexpr char kEnd[] = "end";  // the last field: a line without it was cut off

std::string KeyOf(const ContestCell& cell) {
  char source[20];
  std::snprintf(source, sizeof source, "%016" PRIx64, cell.source);
  return std::string(Name(cell.controller)) + '\t' + cell.program_name + '\t' + cell.machine_name + '\t' +
         std::to_string(cell.seed) + '\t' + source;
}

std::string Number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

bool ReadNumber(const std::string& text, double& value) {
  const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
  return wrong == std::errc{} && end == text.data() + text.size();
}

std::vector<std::string> Split(const std::string& line, char at) {
  std::vector<std::string> parts{""};
  for (const char c : line) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace

std::string CellLine(const std::string& key, const CellResult& result) {
  std::string line = key + '\t' + Number(result.peak_um) + '\t' + Number(result.rms_um) + '\t' +
                     Number(result.encoder_peak_um) + '\t' +
                     (result.circular_deviation_um ? Number(*result.circular_deviation_um) : "") + '\t';
  for (std::size_t i = 0; i < result.window_peak_um.size(); ++i)
    line += (i == 0 ? "" : " ") + Number(result.window_peak_um[i]);
  std::string failure = result.failure;
  std::replace_if(
      failure.begin(), failure.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
  return line + '\t' + failure + '\t' + kEnd;
}

bool ReadCellLine(const std::string& line, std::string& key, CellResult& result) {
  const std::vector<std::string> fields = Split(line, '\t');
  if (fields.size() != 12 || fields[11] != kEnd) return false;
  CellResult read;
  if (!ReadNumber(fields[5], read.peak_um) || !ReadNumber(fields[6], read.rms_um) ||
      !ReadNumber(fields[7], read.encoder_peak_um))
    return false;
  double value = 0.0;
  if (!fields[8].empty()) {
    if (!ReadNumber(fields[8], value)) return false;
    read.circular_deviation_um = value;
  }
  for (const std::string& one : Split(fields[9], ' ')) {
    if (fields[9].empty()) break;
    if (!ReadNumber(one, value)) return false;
    read.window_peak_um.push_back(value);
  }
  read.failure = fields[10];
  key = fields[0];
  for (std::size_t i = 1; i < 5; ++i) key += '\t' + fields[i];
  result = std::move(read);
  return true;
}

KeptCells::KeptCells(const std::filesystem::path& file, bool resume, const std::vector<std::string>& again) {
  if (resume) {
    std::ifstream in(file);
    CellResult result;
    std::string key;
    for (std::string line; std::getline(in, line);)
      if (ReadCellLine(line, key, result)) results_[key] = result;
    std::erase_if(results_, [&](const auto& kept) {
      return std::find(again.begin(), again.end(), kept.first.substr(0, kept.first.find('\t'))) !=
             again.end();
    });
  }
  // Anew, so that lines that do not count go, and a line that was cut off does not run into the next one.
  const std::filesystem::path fresh = file.string() + ".new";
  out_.open(fresh, std::ios::binary | std::ios::trunc);
  for (const auto& [key, result] : results_) out_ << CellLine(key, result) << '\n';
  out_.flush();
  if (!out_) throw std::runtime_error("cannot write " + fresh.string());
  std::filesystem::rename(fresh, file);
}

const CellResult* KeptCells::Find(const ContestCell& cell) const {
  const auto at = results_.find(KeyOf(cell));
  return at == results_.end() ? nullptr : &at->second;
}

void KeptCells::Keep(const ContestCell& cell, const CellResult& result) {
  const std::string key = KeyOf(cell);
  out_ << CellLine(key, result) << '\n' << std::flush;
  if (!out_) throw std::runtime_error("cannot write down results of the contest");
  results_[key] = result;
}

}  // namespace contour
