#include "design/simplex_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace contour {
namespace {

using Point = std::vector<double>;

constexpr double kFirstStep = 0.12;
constexpr double kSmallestSpread = 5e-3;

struct Vertex {
  Point at;
  double cost = 0.0;
};

/// Counts what is spent, and keeps the best.
class Budget {
 public:
  Budget(const std::function<double(const Point&)>& cost, int evaluations)
      : cost_(cost), left_(evaluations) {}
  [[nodiscard]] bool spent() const { return left_ <= 0; }
  Vertex Try(Point at) {
    for (double& x : at) x = std::clamp(x, 0.0, 1.0);
    --left_;
    ++result_.evaluations;
    const Vertex v{at, cost_(at)};
    if (result_.best.empty() || v.cost < result_.cost) {
      result_.best = v.at;
      result_.cost = v.cost;
    }
    return v;
  }
  [[nodiscard]] const SearchResult& result() const { return result_; }

 private:
  const std::function<double(const Point&)>& cost_;
  int left_;
  SearchResult result_;
};

Point Along(const Point& from, const Point& to, double share) {
  Point p(from.size());
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = from[i] + share * (to[i] - from[i]);
  return p;
}

/// Steps towards the middle of the box, so that none is cut off at the border.
std::vector<Vertex> SimplexAround(const Vertex& first, double step, Budget& budget) {
  std::vector<Vertex> simplex{first};
  for (std::size_t i = 0; i < first.at.size() && !budget.spent(); ++i) {
    Point p = first.at;
    p[i] += p[i] > 0.5 ? -step : step;
    simplex.push_back(budget.Try(p));
  }
  return simplex;
}

double Spread(const std::vector<Vertex>& simplex) {
  double spread = 0.0;
  for (const Vertex& v : simplex)
    for (std::size_t i = 0; i < v.at.size(); ++i)
      spread = std::max(spread, std::abs(v.at[i] - simplex.front().at[i]));
  return spread;
}

void Step(std::vector<Vertex>& simplex, Budget& budget) {
  std::stable_sort(simplex.begin(), simplex.end(),
                   [](const Vertex& a, const Vertex& b) { return a.cost < b.cost; });
  Vertex& worst = simplex.back();
  Point centre(worst.at.size(), 0.0);
  for (std::size_t v = 0; v + 1 < simplex.size(); ++v)
    for (std::size_t i = 0; i < centre.size(); ++i)
      centre[i] += simplex[v].at[i] / static_cast<double>(simplex.size() - 1);
  const Vertex reflected = budget.Try(Along(centre, worst.at, -1.0));
  if (reflected.cost < simplex.front().cost) {
    if (budget.spent()) return;
    const Vertex expanded = budget.Try(Along(centre, worst.at, -2.0));
    worst = expanded.cost < reflected.cost ? expanded : reflected;
    return;
  }
  if (reflected.cost < simplex[simplex.size() - 2].cost) {
    worst = reflected;
    return;
  }
  if (budget.spent()) return;
  const bool outside = reflected.cost < worst.cost;
  const Vertex contracted = budget.Try(Along(centre, worst.at, outside ? -0.5 : 0.5));
  if (contracted.cost < std::min(reflected.cost, worst.cost)) {
    worst = contracted;
    return;
  }
  for (std::size_t v = 1; v < simplex.size() && !budget.spent(); ++v)
    simplex[v] = budget.Try(Along(simplex.front().at, simplex[v].at, 0.5));
}

}  // namespace

SearchResult SimplexSearch(const std::function<double(const Point&)>& cost, Point start, int evaluations) {
  Budget budget(cost, evaluations);
  double step = kFirstStep;
  Vertex best = budget.Try(std::move(start));
  while (!budget.spent()) {
    std::vector<Vertex> simplex = SimplexAround(best, step, budget);
    while (!budget.spent() && Spread(simplex) > kSmallestSpread) Step(simplex, budget);
    best = {budget.result().best, budget.result().cost};
    step *= 0.5;
  }
  return budget.result();
}

}  // namespace contour
