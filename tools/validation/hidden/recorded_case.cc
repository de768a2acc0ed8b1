#include "tools/validation/hidden/recorded_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/diagnosis/causes/catalogue.h"
#include "analysis/diagnosis/diagnose.h"
#include "config/whole_file.h"
#include "tools/validation/hidden/draw_setting.h"
#include "tools/validation/hidden/hide_effect.h"
#include "tools/validation/hidden/record_case.h"
#include "tools/validation/hidden/size_effect.h"

namespace contour::hidden {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTruthFile = "truth.json";
constexpr double kBeyondDetectable = 1.5;

/// The size at a factor times what would just be found; false where that is none.
bool SizeFrom(const std::map<std::string, double>& smallest, double factor, Hidden& hidden) {
  const diagnosis::CauseDefinition& cause = diagnosis::CauseNamed(hidden.kind);
  const auto at = smallest.find(std::string(*cause.main_parameter));
  if (at == smallest.end()) return false;
  hidden.size = std::copysign((*cause.specimen->size_at)(factor, at->second), hidden.size);
  return std::abs(hidden.size) > 0.0;
}

/// The size at which diagnosis says that it would just be seen, times one and a half.
Hidden Detectable(Hidden hidden, const Setting& setting, const std::filesystem::path& directory) {
  Record(setting, {}, directory);
  const Recorded clean = ReadRecorded(directory);
  const diagnosis::Diagnosis answer = diagnosis::Diagnose(clean.log, clean.stated, {});
  const auto at = answer.smallest_detectable.find(hidden.kind);
  if (at == answer.smallest_detectable.end() || !SizeFrom(at->second, kBeyondDetectable, hidden))
    throw std::runtime_error("no smallest_detectable is stated");
  if (std::abs(hidden.size) > LargestSize(hidden))
    throw std::runtime_error("smallest_detectable is beyond all reason");
  return hidden;
}

void Make(KnownCase& known, const std::filesystem::path& directory) {
  const Question& q = known.question;
  const Setting setting = DrawSetting(q.seed, q.kinds, q.misfit, q.length);
  // The strength is that on a machine without misfit.
  Setting plain = setting;
  plain.misfit = Misfit::kNone;
  if (q.misfit == Misfit::kDelayAndLag) plain.truth.lag_ms = plain.stated.lag_ms;
  for (std::size_t i = 0; i < q.kinds.size(); ++i) {
    const Hidden drawn = DrawEffect(q.seed + i, q.kinds[i], setting);
    if (q.type == Question::Type::kDetectable) {
      known.hidden.push_back(Detectable(drawn, setting, directory));
    } else {
      const auto sized = SizeEffect(plain, drawn, q.strength, directory);
      if (!sized) throw std::runtime_error("the effect does not get that strong on this machine");
      known.hidden.push_back(*sized);
    }
  }
  const LogSpan span = Record(setting, known.hidden, directory);
  for (Hidden& hidden : known.hidden) hidden.truth = TruthOf(hidden, span);
  known.usable = true;
}

template <class Enum, std::size_t n>
Enum FromName(const std::string& name, const std::array<Enum, n>& all) {
  for (const Enum one : all)
    if (name == Name(one)) return one;
  throw std::runtime_error(std::string(kTruthFile) + ": there is no '" + name + "'");
}

Json ToJson(const KnownCase& known) {
  const Question& q = known.question;
  Json json = {{"type", Name(q.type)},   {"kinds", q.kinds},         {"strength", Name(q.strength)},
               {"seed", q.seed},         {"misfit", Name(q.misfit)}, {"length", Name(q.length)},
               {"usable", known.usable}, {"why_not", known.why_not}, {"hidden", Json::array()}};
  for (const Hidden& h : known.hidden)
    json["hidden"].push_back({{"kind", h.kind},
                              {"size", h.size},
                              {"order", h.order},
                              {"phase_rad", h.phase_rad},
                              {"second", h.second},
                              {"parameters", h.truth}});
  return json;
}

}  // namespace

KnownCase RecordCase(const Question& question, const std::filesystem::path& directory, bool compact) {
  KnownCase known;
  known.question = question;
  try {
    Make(known, directory);
    if (compact) Compact(directory);
  } catch (const std::exception& e) {
    known.why_not = e.what();
    std::filesystem::remove(directory / "log.lcm");
  }
  // Last, and in one step: its presence says that the case is complete.
  WriteWholeFile(directory / kTruthFile, ToJson(known).dump(1) + "\n");
  return known;
}

KnownCase ReadTruth(const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / kTruthFile;
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  try {
    const Json json = Json::parse(in);
    KnownCase known;
    Question& q = known.question;
    q.type = FromName(json.at("type"), std::array{Question::Type::kClean, Question::Type::kEffect,
                                                  Question::Type::kPair, Question::Type::kDetectable});
    q.kinds = json.at("kinds").get<std::vector<std::string>>();
    q.strength =
        FromName(json.at("strength"), std::array{Strength::kClear, Strength::kModerate, Strength::kBarely});
    q.seed = json.at("seed");
    q.misfit =
        FromName(json.at("misfit"), std::array{Misfit::kNone, Misfit::kMaxwellSlip, Misfit::kTimingError,
                                               Misfit::kNoiseLevel, Misfit::kDelayAndLag});
    q.length = FromName(json.at("length"), std::array{Length::kLong, Length::kShort});
    known.usable = json.at("usable");
    known.why_not = json.at("why_not");
    for (const Json& one : json.at("hidden"))
      known.hidden.push_back({one.at("kind"), one.at("size"), one.at("order"), one.at("phase_rad"),
                              one.at("second"), one.at("parameters").get<std::map<std::string, double>>()});
    return known;
  } catch (const nlohmann::json::exception& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
}

bool IsRecorded(const std::filesystem::path& directory) {
  return std::filesystem::exists(directory / kTruthFile);
}

}  // namespace contour::hidden
