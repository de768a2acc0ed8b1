// The contour MPC's problem for two axes: our Riccati solver, warm-started as the controller does, and QP
// libraries on the same problems in the same order, condensing included. Each must agree with ours to 1e-6 of
// the limit, or the row is an error.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "tools/bench/condensed_problem.h"
#include "tools/bench/contour_problems.h"
#include "tools/bench/latencies.h"

#ifdef CONTOUR_HAVE_EIQUADPROG
#include <eiquadprog/eiquadprog-rt.hpp>
#endif
#ifdef CONTOUR_HAVE_PROXSUITE
#include <proxsuite/proxqp/dense/dense.hpp>
#endif
#ifdef CONTOUR_HAVE_QPOASES
#include <qpOASES.hpp>
#endif

namespace contour::bench {
namespace {

constexpr std::size_t kProblems = 2000;

const ContourProblems& Problems(std::size_t horizon) {
  static std::map<std::size_t, ContourProblems> made;
  auto at = made.find(horizon);
  if (at == made.end()) at = made.emplace(horizon, MakeContourProblems(horizon, kProblems)).first;
  return at->second;
}

/// Largest difference to our solution, in units of the limit; x has axis 0 first.
double Difference(const ContourProblems& all, std::size_t k, const Eigen::VectorXd& x) {
  const std::size_t n = all.problems[k].horizon;
  double worst = 0.0;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < 2; ++i)
      worst = std::max(worst, std::abs(x(static_cast<Eigen::Index>(i * n + j)) - all.solutions[k][j][i]));
  return worst / all.limit_m_s2;
}

/// Runs `solve(condensed) -> x` over all problems, again and again.
template <class Solve>
void RunLibrary(benchmark::State& state, std::size_t horizon, Solve&& solve) {
  const ContourProblems& all = Problems(horizon);
  CondensedProblem condensed(all.problems.front());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 * horizon));
  double worst = 0.0;
  std::size_t k = 0;
  {
    Latencies latencies(state);
    for (auto _ : state) {
      latencies.Time([&] {
        condensed.Condense(all.problems[k]);
        solve(condensed, x);
      });
      worst = std::max(worst, Difference(all, k, x));
      k = (k + 1) % all.problems.size();
    }
  }
  state.counters["worst_difference"] = worst;
  if (!(worst < 1e-6)) state.SkipWithError("differs from our solution by more than 1e-6 of the limit");
}

void Contour(benchmark::State& state) {
  const ContourProblems& all = Problems(static_cast<std::size_t>(state.range(0)));
  auto solver = std::make_unique<QpSolver<2>>();
  QpSolver<2>::Active active{};
  QpSolver<2>::Inputs input{};
  auto problem = std::make_unique<QpProblem<2>>();
  std::size_t k = 0;
  Latencies latencies(state);
  for (auto _ : state) {
    *problem = all.problems[k];  // the solver writes into it
    if (k == 0) active = {};
    latencies.Time([&] {
      for (std::size_t j = 0; j + 1 < problem->horizon; ++j) active[j] = active[j + 1];
      solver->Solve(*problem, 30, active, input);
    });
    benchmark::DoNotOptimize(input);
    k = (k + 1) % all.problems.size();
  }
  state.counters["bound_active_share"] = all.share_active;
}
BENCHMARK(Contour)
    ->Name("mpc/contour")
    ->Arg(10)
    ->Arg(20)
    ->Arg(40)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

void Condensing(benchmark::State& state) {
  const ContourProblems& all = Problems(static_cast<std::size_t>(state.range(0)));
  CondensedProblem condensed(all.problems.front());
  std::size_t k = 0;
  Latencies latencies(state);
  for (auto _ : state) {
    latencies.Time([&] { condensed.Condense(all.problems[k]); });
    benchmark::DoNotOptimize(condensed.hessian.data());
    k = (k + 1) % all.problems.size();
  }
}
BENCHMARK(Condensing)
    ->Name("mpc/condensing_alone")
    ->Arg(10)
    ->Arg(20)
    ->Arg(40)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

#ifdef CONTOUR_HAVE_EIQUADPROG
template <int N>
void Eiquadprog(benchmark::State& state) {
  constexpr int kInputs = 2 * N;
  using Solver = eiquadprog::solvers::RtEiquadprog<kInputs, 0, 2 * kInputs>;
  auto solver = std::make_unique<Solver>();
  auto hessian = std::make_unique<Eigen::Matrix<double, kInputs, kInputs>>();
  auto bounds = std::make_unique<Eigen::Matrix<double, 2 * kInputs, kInputs>>();
  bounds->setZero();
  bounds->topRows(kInputs).setIdentity();
  bounds->bottomRows(kInputs) = -Eigen::MatrixXd::Identity(kInputs, kInputs);
  const Eigen::Matrix<double, 0, kInputs> none;
  const Eigen::Matrix<double, 0, 1> nothing;
  Eigen::Matrix<double, 2 * kInputs, 1> offset;
  Eigen::Matrix<double, kInputs, 1> gradient, found;
  RunLibrary(state, N, [&](const CondensedProblem& c, Eigen::VectorXd& x) {
    *hessian = c.hessian;
    gradient = c.gradient;
    offset << -c.lower, c.upper;
    solver->solve_quadprog(*hessian, gradient, none, nothing, *bounds, offset, found);
    x = found;
  });
}
BENCHMARK(Eiquadprog<10>)->Name("mpc/eiquadprog/10")->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(Eiquadprog<20>)->Name("mpc/eiquadprog/20")->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(Eiquadprog<40>)->Name("mpc/eiquadprog/40")->UseManualTime()->Unit(benchmark::kMicrosecond);
#endif

#ifdef CONTOUR_HAVE_PROXSUITE
void ProxQp(benchmark::State& state) {
  const auto horizon = static_cast<std::size_t>(state.range(0));
  const Eigen::Index inputs = static_cast<Eigen::Index>(2 * horizon);
  namespace dense = proxsuite::proxqp::dense;
  dense::QP<double> qp(inputs, 0, 0, true);
  qp.settings.eps_abs = 1e-9;
  qp.settings.initial_guess = proxsuite::proxqp::InitialGuessStatus::WARM_START_WITH_PREVIOUS_RESULT;
  bool first = true;
  RunLibrary(state, horizon, [&](const CondensedProblem& c, Eigen::VectorXd& x) {
    using proxsuite::nullopt;
    if (first)
      qp.init(c.hessian, c.gradient, nullopt, nullopt, nullopt, nullopt, nullopt, c.lower, c.upper);
    else
      qp.update(c.hessian, c.gradient, nullopt, nullopt, nullopt, nullopt, nullopt, c.lower, c.upper);
    first = false;
    qp.solve();
    x = qp.results.x;
  });
}
BENCHMARK(ProxQp)
    ->Name("mpc/proxqp")
    ->Arg(10)
    ->Arg(20)
    ->Arg(40)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
#endif

#ifdef CONTOUR_HAVE_QPOASES
void QpOases(benchmark::State& state) {
  const auto horizon = static_cast<std::size_t>(state.range(0));
  qpOASES::SQProblem solver(static_cast<qpOASES::int_t>(2 * horizon), 0);
  qpOASES::Options options;
  options.setToMPC();
  options.printLevel = qpOASES::PL_NONE;
  solver.setOptions(options);
  bool first = true;
  RunLibrary(state, horizon, [&](const CondensedProblem& c, Eigen::VectorXd& x) {
    qpOASES::int_t steps = 1000;
    const double* h = c.hessian.data();
    if (first)
      solver.init(h, c.gradient.data(), nullptr, c.lower.data(), c.upper.data(), nullptr, nullptr, steps);
    else
      solver.hotstart(h, c.gradient.data(), nullptr, c.lower.data(), c.upper.data(), nullptr, nullptr, steps);
    first = false;
    solver.getPrimalSolution(x.data());
  });
}
BENCHMARK(QpOases)
    ->Name("mpc/qpoases")
    ->Arg(10)
    ->Arg(20)
    ->Arg(40)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
}  // namespace contour::bench
