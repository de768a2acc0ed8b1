#include "tools/validation/emps/emps_report.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "analysis/diagnosis/causes/kind_words.h"
#include "analysis/diagnosis/diagnose.h"
#include "analysis/diagnosis/report/diagnosis_text.h"
#include "analysis/recording/read_log.h"
#include "tools/validation/emps/inverse_dynamics.h"
#include "tools/validation/emps/models.h"

namespace contour::emps {
namespace {

std::string Fixed(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}
std::string Um(double metres) { return Fixed(1e6 * metres, 0); }
std::string Percent(double before, double after) { return Fixed(100.0 * (1.0 - after / before), 0) + " %"; }

struct Data {
  Recording train, pulses;
};

/// The authors' symmetric model, as the simulation would run with it: its numbers are taken to be known to a
/// few per cent.
diagnosis::StatedAxis AuthorsAxis() {
  const Parameters p = AuthorsSymmetric();
  diagnosis::StatedAxis axis;
  axis.source = "the authors' symmetric model";
  axis.linear = true;
  axis.lead_m = kTurn_m;
  axis.motor_inertia = p.mass_kg;
  axis.friction.Fc_plus = axis.friction.Fc_minus = axis.friction.Fs_plus = axis.friction.Fs_minus =
      p.Fc_plus_N;
  axis.friction.vs = 2e-3;
  axis.friction.s0 = p.Fc_plus_N / 2e-6;
  axis.friction.s2 = p.Fv_plus_Ns_m;
  axis.offset = p.offset_N;
  axis.position_step = 5e-8;
  return axis;
}

diagnosis::AxisLog LogOf(const std::filesystem::path& file, const Segment& rows) {
  diagnosis::ReadOptions read;
  read.columns =
      diagnosis::ParseColumnNames("time_s=t_s,force_N=force_N,position_m=qm_m,reference_position_m=qg_m");
  diagnosis::AxisLog log = diagnosis::ReadCsvLog(file.string(), read);
  const auto cut = [&](auto& column) {
    if (column.empty()) return;
    column.resize(std::min(rows.to, column.size()));
    column.erase(column.begin(), column.begin() + static_cast<std::ptrdiff_t>(rows.from));
  };
  cut(log.present);
  for (auto* column : {&log.command, &log.position, &log.reference_position}) cut(*column);
  log.rows = log.size();
  return log;
}

/// The names of the parameters are those of a rotary axis; here a torque is a force and an angle a position.
std::string InNewtons(std::string value) {
  if (const std::size_t at = value.find(" Nm"); at != std::string::npos) value.replace(at, 3, " N");
  if (const std::size_t at = value.find(" rad"); at != std::string::npos) value.replace(at, 4, " m");
  return value;
}

std::string FoundText(const diagnosis::Diagnosis& found) {
  std::string out = diagnosis::VerdictText(found) + "\n\n";
  if (found.causes.empty()) return out;
  out +=
      "| named | size | log evidence | residual on unseen blocks | less |\n| --- | --- | --- | --- | --- |\n";
  for (const diagnosis::Cause& c : found.causes) {
    std::string kinds = "`" + c.kind + "`";
    for (const std::string& other : c.indistinguishable_from) kinds += " or `" + other + "`";
    std::string size;
    for (const auto& [name, p] : c.parameters)
      size += (size.empty() ? "" : ", ") + diagnosis::ParameterWords(name) + " " +
              (name == "phase_rad" ? diagnosis::ValueWords(name, p.value)
                                   : InNewtons(diagnosis::ValueWords(name, p.value)));
    out += "| " + kinds + " | " + size + " | " + Fixed(c.log_evidence_gain, 0) + " | " +
           Fixed(c.heldout_rms_before, 3) + " to " + Fixed(c.heldout_rms_after, 3) + " " + c.unit + " | " +
           Fixed(100.0 * c.heldout_gain, 0) + " % |\n";
  }
  return out + "\n";
}

std::string ModelTable(std::vector<ScoredModel> models, const std::vector<ScoredModel>& more) {
  models.insert(models.end(), more.begin(), more.end());
  std::string out =
      "| model | train, first half | train, second half | pulses |\n| --- | --- | --- | --- |\n";
  for (const ScoredModel& m : models)
    out += "| " + m.name + " | " + Um(m.first_m) + " um | " + Um(m.second_m) + " um | " + Um(m.pulses_m) +
           " um |\n";
  return out + "\n";
}

std::vector<ScoredModel> ScoreModels(const Data& data) {
  std::vector<ScoredModel> models;
  const auto add = [&](const std::string& name, const Parameters& p) {
    models.push_back(Score(name, p, data.train, data.pulses));
  };
  add("authors, symmetric", AuthorsSymmetric());
  add("authors, friction per direction", AuthorsAsymmetric());
  Parameters p = FitFreeRun(AuthorsAsymmetric(), DirectionTerms(), data.train, kFirstHalf, kFitWindow);
  add("friction per direction, fitted", p);
  p = FitFreeRun(p, StrokeTerms(), data.train, kFirstHalf, kFitWindow);
  add("and friction along the stroke, fitted", p);
  return models;
}

/// The last model fitted on free runs of another length.
std::vector<ScoredModel> OtherLengths(const Data& data) {
  std::vector<ScoredModel> models;
  for (const std::size_t window : {std::size_t{1000}, std::size_t{3000}}) {
    Parameters p = FitFreeRun(AuthorsAsymmetric(), DirectionTerms(), data.train, kFirstHalf, window);
    p = FitFreeRun(p, StrokeTerms(), data.train, kFirstHalf, window);
    models.push_back(Score("the last one, fitted on free runs of " + std::to_string(window / 1000) + " s", p,
                           data.train, data.pulses));
  }
  return models;
}

struct ForceStep {
  std::string name;
  ForceTerms terms;
};

std::string ForceTable(const Data& data) {
  const std::vector<ForceStep> steps = {
      {"symmetric Coulomb and viscous friction", {}},
      {"viscous friction per direction", {true, false, false, false}},
      {"and friction at low speed", {true, true, false, false}},
      {"and a ripple once and twice per motor turn", {true, true, true, false}},
      {"and friction along the stroke", {true, true, true, true}}};
  std::string out =
      "| force model | train, second half | gain of the step | pulses | gain | pulses, fitted on their first "
      "half | gain |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  double second = 0.0, pulses = 0.0, own = 0.0;
  for (const ForceStep& step : steps) {
    const ForceFit fit(step.terms, data.train, kFirstHalf);
    const ForceFit own_fit(step.terms, data.pulses, kFirstHalf);
    const double a = fit.Residual_N(data.train, kSecondHalf);
    const double b = fit.Residual_N(data.pulses, kWhole);
    const double c = own_fit.Residual_N(data.pulses, kSecondHalf);
    const bool first = second == 0.0;
    out += "| " + step.name + " | " + Fixed(a, 2) + " N | " + (first ? "" : Percent(second, a)) + " | " +
           Fixed(b, 2) + " N | " + (first ? "" : Percent(pulses, b)) + " | " + Fixed(c, 2) + " N | " +
           (first ? "" : Percent(own, c)) + " |\n";
    second = a;
    pulses = b;
    own = c;
  }
  return out + "\n";
}

std::string DifferenceText(const Data& data, const std::vector<ScoredModel>& models) {
  const ForceTerms terms{true, true, true, true};
  const ForceFit train(terms, data.train, kWhole);
  const ForceFit pulses(terms, data.pulses, kWhole);
  const auto a = train.FrictionLevels();
  const auto b = pulses.FrictionLevels();
  const double phase = std::remainder(std::arg(pulses.OncePerTurn_N()) - std::arg(train.OncePerTurn_N()),
                                      2.0 * std::numbers::pi);
  const Parameters own =
      FitFreeRun(models.back().parameters, DirectionTerms(), data.pulses, kFirstHalf, kFitWindow);
  const double own_m = FreeRunRmse_m(own, data.pulses, kSecondHalf);
  const double moved_m = FreeRunRmse_m(models.back().parameters, data.pulses, kSecondHalf);
  std::string out =
      "| fitted on | Coulomb + | Coulomb - | viscous + | viscous - | force once per turn |\n"
      "| --- | --- | --- | --- | --- | --- |\n";
  const auto row = [&](const char* name, const ForceFit::Levels& l, const ForceFit& f) {
    return std::string("| ") + name + " | " + Fixed(l.Fc_plus_N, 2) + " N | " + Fixed(l.Fc_minus_N, 2) +
           " N | " + Fixed(l.Fv_plus_Ns_m, 0) + " Ns/m | " + Fixed(l.Fv_minus_Ns_m, 0) + " Ns/m | " +
           Fixed(std::abs(f.OncePerTurn_N()), 2) + " N |\n";
  };
  out += row("train", a, train) + row("pulses", b, pulses);
  out += "\n**Friction differs between the two recordings.** Coulomb friction in pulses is " +
         Fixed(50.0 * (b.Fc_plus_N / a.Fc_plus_N + b.Fc_minus_N / a.Fc_minus_N) - 100.0, 1) +
         " % higher than in train. The force once per motor turn has nearly the same size in both but its "
         "phase differs by " +
         Fixed(std::abs(phase) * 180.0 / std::numbers::pi, 0) +
         " degrees: the axis was homed anew, presumably, so a ripple fitted on one recording does not serve "
         "the other. "
         "A model fitted on the first half of pulses leaves " +
         Um(own_m) + " um on their second half, where the one fitted on train leaves " + Um(moved_m) +
         " um: no model of train fits pulses fully.\n";
  return out;
}

/// What the pictures are drawn from.
void WriteData(const std::filesystem::path& file, const Data& data, const std::vector<ScoredModel>& models) {
  std::ofstream out(file);
  const ForceFit symmetric({}, data.train, kFirstHalf);
  const ForceFit full({true, true, true, true}, data.train, kFirstHalf);
  out << "t_s,position_m,velocity_m_s,residual_symmetric_N,residual_full_N,error_symmetric_m,error_fitted_"
         "m\n";
  std::vector<double> before(data.train.position_m.size(), NAN), after = before;
  for (const std::size_t start : kSecondHalf.Windows(kWindow, kWindow)) {
    const std::vector<double> x = FreeRun(models.front().parameters, data.train, start, kWindow);
    const std::vector<double> y = FreeRun(models.back().parameters, data.train, start, kWindow);
    for (std::size_t k = 0; k < kWindow; ++k) {
      before[start + k] = x[k] - data.train.position_m[start + k];
      after[start + k] = y[k] - data.train.position_m[start + k];
    }
  }
  for (std::size_t k = kSecondHalf.from; k < kSecondHalf.to; ++k)
    out << data.train.time_s[k] << ',' << data.train.slow_position_m[k] << ','
        << data.train.slow_velocity_m_s[k] << ',' << symmetric.ResidualAt_N(data.train, k) << ','
        << full.ResidualAt_N(data.train, k) << ',' << before[k] << ',' << after[k] << '\n';
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

bool HasRecordings(const std::filesystem::path& emps) {
  return std::filesystem::exists(emps / "emps_train.csv") &&
         std::filesystem::exists(emps / "emps_pulses.csv");
}

void WriteEmpsReport(const ReportOptions& options) {
  const auto say = [&](const char* doing, double share) {
    if (options.progress) options.progress(doing, share);
  };
  say("reading", 0.0);
  const Data data{ReadRecording((options.emps / "emps_train.csv").string(), "train"),
                  ReadRecording((options.emps / "emps_pulses.csv").string(), "pulses")};
  say("fitting free runs", 0.1);
  const std::vector<ScoredModel> models = ScoreModels(data);
  diagnosis::DiagnoseOptions how;
  how.threads = options.threads;
  how.most_effects = 8;  // a real axis has more than one
  how.progress = options.progress;
  const auto train =
      diagnosis::Diagnose(LogOf(options.emps / "emps_train.csv", {100, 24700}), AuthorsAxis(), how);
  const auto pulses =
      diagnosis::Diagnose(LogOf(options.emps / "emps_pulses.csv", {100, 24700}), AuthorsAxis(), how);
  std::ostringstream md;
  md << "# EMPS: a real ball-screw axis\n\n"
        "Made by `contour emps --emps DIR --out docs/laboratory` from `emps_train.csv` and `emps_pulses.csv` "
        "of A. "
        "Janot, M. Gautier, M. Brunot, "
        "\"Data Set and Reference Models of EMPS\", Workshop on Nonlinear System Identification Benchmarks, "
        "2019 "
        "([nonlinearbenchmark.org](https://www.nonlinearbenchmark.org)). The data are the authors'; they are "
        "not part of this repository.\n\n"
        "A linear axis at 1 kHz: a force in N moves a carriage of 95 kg; 2.5 mm of travel per motor turn. "
        "Two recordings of 24.8 s.\n\n"
        "## What the authors' model gets wrong, named unaided\n\n"
        "`contour diagnose` is given a recording and the authors' symmetric model, nothing else.\n\n### "
        "train\n\n"
     << FoundText(train) << "### pulses\n\n"
     << FoundText(pulses)
     << "## Free runs of one second\n\n"
        "Windows of 1000 rows, started from the filtered measurement (4th-order Butterworth at 150 Hz, "
        "forward and backward), then on the "
        "recorded force alone; root mean square against the raw position. First half: rows 100 to 12420; "
        "second half: 12420 to 24700; pulses: 100 to "
        "24700. Fitted models have seen the first half of train only: free runs of two seconds, one every "
        "quarter of a second "
        "(the length, and that the stroke's curve is a parabola, were chosen with the results in sight; the "
        "last "
        "rows show other lengths).\n\n"
     << ModelTable(models, OtherLengths(data))
     << "![Free-run error on the second half of train](emps_free_run.png)\n\n"
        "## What each cause gains\n\n"
        "Force residual of inverse dynamics above 2 mm/s, everything filtered at 50 Hz, fitted by least "
        "squares on the first half of train; "
        "the last columns on the first half of pulses and scored on their second half.\n\n"
     << ForceTable(data)
     << "![Force residual over the motor's turn and over velocity](emps_residual.png)\n\n## The two "
        "recordings\n\n"
     << DifferenceText(data, models);
  std::filesystem::create_directories(options.out);
  WriteData(options.out / "emps_data.csv", data, models);
  const std::filesystem::path file = options.out / "emps.md";
  std::ofstream out(file);
  out << md.str();
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace contour::emps
