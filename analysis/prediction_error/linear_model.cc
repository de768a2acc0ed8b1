#include "analysis/prediction_error/linear_model.h"

#include <algorithm>
#include <cmath>

#include "analysis/prediction_error/lane_bundle.h"
#include "analysis/prediction_error/simd/lane_loops.h"

namespace contour::diagnosis {
namespace {

// Places in an entry of Lanes::tangent.
enum Slot { kInnovation, kTh, kW, kDrag, kZ, kSoft, kThl, kWl };

struct Direction {
  LaneValues LanePush::*push;
  double size;
};

struct Directions {
  std::vector<Slot> states;        // th first
  std::vector<Direction> columns;  // of the states after th, then the reading, then the inputs
};

Directions DirectionsOf(const AxisModel& m) {
  const double z = m.friction.Fc_plus / m.friction.s0;
  const double w = 1e-5 * m.friction.vs;
  const double u = 1e-4 * m.friction.Fc_plus;
  Directions d;
  d.states = {kTh, kW, kDrag, kZ};
  d.columns = {{&LanePush::w, w}, {&LanePush::drag, u}, {&LanePush::z, 1e-4 * z}};
  if (m.two_inertia) {
    d.states.insert(d.states.end(), {kThl, kWl});
    d.columns.insert(d.columns.end(), {{&LanePush::thl, 1e-4 * z}, {&LanePush::wl, w}});
  }
  if (m.soft_share > 0.0) {
    d.states.push_back(kSoft);
    d.columns.push_back({&LanePush::soft, 1e-4 * z});
  }
  d.columns.push_back({&LanePush::reading, 1e-4 * z});
  d.columns.push_back({&LanePush::motor_from, u});
  d.columns.push_back({&LanePush::motor_to, u});
  if (m.two_inertia) {
    d.columns.push_back({&LanePush::load_from, u});
    d.columns.push_back({&LanePush::load_to, u});
  }
  d.columns.push_back({&LanePush::level_from, 1e-4});
  d.columns.push_back({&LanePush::level_to, 1e-4});
  return d;
}

// Where the column of a direction goes: e at `e` (with its sign), states at `x`, `step` apart.
struct Place {
  std::size_t e, x, step;
};

/// Places of the blocks in one transition: A, c, G, then the inputs.
struct Layout {
  std::size_t n = 0, c = 0, g = 0, inputs = 0;
};

LinearModel EmptyModel(const FilterSetup& setup, const AxisModel& model, std::size_t n) {
  const std::size_t rows = setup.log->size();
  LinearModel out;
  out.rows = rows;
  out.states = static_cast<int>(n);
  out.table_state = model.two_inertia ? 4 : 0;
  out.stride = n * n + 2 * n + kLinearInputs * (n + 1);
  out.step.assign((rows - 1) * out.stride, 0.0F);
  out.valid = setup.valid;
  for (const Segment& piece : setup.pieces)
    if (piece.from > 0) out.begins.push_back(piece.from);
  out.viscous = model.friction.s2;
  out.friction_on_load = model.two_inertia && model.friction_on_load;
  out.innovation.resize(rows);
  out.velocity.resize(rows);
  out.table.resize(rows);
  return out;
}

std::vector<Place> PlacesOf(const Directions& d, const Layout& at, bool two_inertia) {
  std::vector<Place> places;
  for (std::size_t j = 1; j < at.n; ++j) places.push_back({at.c + j, j, at.n});
  places.push_back({at.g, at.g, 1});  // the reading: its innovation is `valid`, written over by G
  for (std::size_t i = 0; i + at.n < d.columns.size(); ++i) {
    // Rigid axes have one force; it serves as the load's too.
    const std::size_t which = two_inertia || i < 2 ? i : i + 2;
    const std::size_t input = at.inputs + which * (at.n + 1);
    places.push_back({input, input + 1, 1});
  }
  return places;
}

constexpr std::size_t kDirectionsAtOnce = kLanes - 1;

/// What each of a bundle's directions made of each transition.
using Tangent = std::vector<float>;

/// A bundle whose first lane is not moved, and the others in one direction each, from `first` on.
Lanes Pushed(const Lanes& unmoved, const Directions& d, std::size_t first, Tangent& tangent) {
  Lanes m = unmoved;
  m.push.inverse = m.push.inverse + 1.0;
  for (std::size_t i = 0; i < kDirectionsAtOnce && first + i < d.columns.size(); ++i) {
    const Direction& direction = d.columns[first + i];
    (m.push.*direction.push)[i + 1] = direction.size;
    m.push.inverse[i + 1] = 1.0 / direction.size;
  }
  m.tangent = tangent.data();
  return m;
}

void KeepTangent(const Directions& d, const std::vector<Place>& places, std::size_t first,
                 const Tangent& tangent, LinearModel& out) {
  const std::size_t count = std::min(kDirectionsAtOnce, d.columns.size() - first);
  for (std::size_t k = 0; k + 1 < out.rows; ++k) {
    float* to = &out.step[k * out.stride];
    for (std::size_t i = 0; i < count; ++i) {
      const float* from = &tangent[(k * kDirectionsAtOnce + i) * kTangentStates];
      const Place& place = places[first + i];
      to[place.e] = -from[kInnovation];
      for (std::size_t s = 0; s < d.states.size(); ++s) to[place.x + s * place.step] = from[d.states[s]];
    }
  }
}

/// Runs the model with each direction pushed in a lane of its own, two bundles side by side, and keeps what
/// the push made of each transition.
void RunDirections(const FilterSetup& setup, const AxisModel& model, const Directions& d,
                   const std::vector<Place>& places, LinearModel& out) {
  const std::size_t rows = out.rows;
  FilterSetup traced = setup;
  traced.full = true;
  traced.trace = true;
  Delivered delivered;
  DeliveredMeans(*setup.log, model.delay_s - model.lag_for_delay_s, model.lag_s + model.lag_for_delay_s,
                 SubstepsOf(setup, model), setup.pieces, delivered);
  std::vector<double> measured = setup.log->position, zeros(rows, 0.0), spare(rows);
  for (std::size_t k = 0; k < rows; ++k)
    if (setup.valid[k] == 0) measured[k] = 0.0;
  const AxisModel* models[] = {&model};
  const Delivered* means[] = {&delivered};
  Lanes unmoved = MakeLanes(traced, models, means, measured.data(), zeros.data());
  for (std::size_t i = 0; i < kLanes; ++i) {
    unmoved.innovation[i] = i == 0 ? out.innovation.data() : spare.data();
    unmoved.velocity[i] = i == 0 ? out.velocity.data() : spare.data();
    unmoved.friction[i] = spare.data();
    unmoved.table[i] = i == 0 ? out.table.data() : spare.data();
  }
  const Segment all{.rows = rows};
  const std::span<const Segment> pieces =
      setup.pieces.empty() ? std::span<const Segment>(&all, 1) : std::span<const Segment>(setup.pieces);
  Tangent tangent[2];
  for (Tangent& t : tangent) t.resize((rows - 1) * kDirectionsAtOnce * kTangentStates);
  for (std::size_t first = 0; first < d.columns.size(); first += 2 * kDirectionsAtOnce) {
    const std::size_t next = first + kDirectionsAtOnce;
    const Lanes one = Pushed(unmoved, d, first, tangent[0]);
    const Lanes other = Pushed(unmoved, d, next, tangent[1]);
    for (const Segment& piece : pieces) {
      const bool whole = setup.pieces.empty();
      Lanes a = whole ? one : Over(one, piece), b = whole ? other : Over(other, piece);
      a.tangent += piece.from * kDirectionsAtOnce * kTangentStates;
      b.tangent += piece.from * kDirectionsAtOnce * kTangentStates;
      BestLoops().run_both(a, b);
    }
    KeepTangent(d, places, first, tangent[0], out);
    if (next < d.columns.size()) KeepTangent(d, places, next, tangent[1], out);
  }
}

/// Everything moved together, the reading too, changes nothing: the motor's position is that less the
/// reading, less the load's.
void CompleteFrames(const FilterSetup& setup, const Directions& d, const Layout& at, bool two_inertia,
                    LinearModel& out) {
  const auto [n, c, g, inputs] = at;
  for (std::size_t k = 0; k + 1 < out.rows; ++k) {
    float* p = &out.step[k * out.stride];
    const float valid = setup.valid[k + 1] != 0 ? 1.0F : 0.0F;
    for (std::size_t s = 0; s < n; ++s) {
      const bool frame = d.states[s] == kTh || d.states[s] == kThl;
      p[s * n] = (frame ? 1.0F : 0.0F) - p[g + s] - (two_inertia ? p[s * n + 4] : 0.0F);
    }
    p[c] = valid - (two_inertia ? p[c + 4] : 0.0F);
    if (!two_inertia) std::copy_n(p + inputs, 2 * (n + 1), p + inputs + 2 * (n + 1));
  }
}

}  // namespace

LinearModel Linearise(const FilterSetup& setup, const AxisModel& model) {
  const Directions d = DirectionsOf(model);
  const std::size_t n = d.states.size();
  const Layout at{n, n * n, n * n + n, n * n + 2 * n};
  LinearModel out = EmptyModel(setup, model, n);
  RunDirections(setup, model, d, PlacesOf(d, at, model.two_inertia), out);
  CompleteFrames(setup, d, at, model.two_inertia, out);
  for (const std::size_t k : out.begins)
    std::fill_n(out.step.begin() + static_cast<std::ptrdiff_t>((k - 1) * out.stride), out.stride, 0.0F);
  return out;
}

std::vector<FilterRun> LinearColumns(const LinearModel& model, std::span<const LinearInput> inputs,
                                     bool table) {
  std::vector<FilterRun> out(inputs.size());
  const std::vector<double> zeros(model.rows, 0.0);
  std::vector<double> spare(model.rows);
  for (std::size_t first = 0; first < inputs.size(); first += kLanes) {
    LaneColumns m;
    m.rows = model.rows;
    m.stride = model.stride;
    m.states = model.states;
    m.table_state = model.table_state;
    m.step = model.step.data();
    m.valid = model.valid.data();
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool used = first + i < inputs.size();
      const LinearInput none, &in = used ? inputs[first + i] : none;
      const auto set = [&](LaneSignal& lane, const SharedSignal& s, bool& any) {
        lane.from.at[i] = s ? s->data() : zeros.data();
        lane.to.at[i] = s ? s->data() + (s->size() == 2 * model.rows ? model.rows : 1) : zeros.data();
        any = any || s;
      };
      set(m.motor, in.motor_force, m.has_motor);
      set(m.load, in.load_force, m.has_load);
      set(m.level, in.level, m.has_level);
      m.reading[i] = in.reading_error ? in.reading_error->data() : zeros.data();
      m.has_reading = m.has_reading || in.reading_error;
      if (used) {
        out[first + i].innovation.resize(model.rows);
        if (table) out[first + i].table_position.resize(model.rows);
      }
      m.innovation[i] = used ? out[first + i].innovation.data() : spare.data();
      if (table) m.table[i] = used ? out[first + i].table_position.data() : spare.data();
    }
    BestLoops().columns(m);
  }
  return out;
}

namespace {

SharedSignal Difference(const SharedSignal& without, const SharedSignal& with, std::size_t rows, double per) {
  if (without == with) return nullptr;
  const std::size_t size = std::max(without ? without->size() : rows, with ? with->size() : rows);
  auto out = std::make_shared<Signal>(size, 0.0);
  const auto add = [&](const SharedSignal& s, double factor) {
    if (!s) return;
    if (s->size() == size) {
      for (std::size_t k = 0; k < size; ++k) (*out)[k] += factor * (*s)[k];
      return;
    }
    for (std::size_t k = 0; k < rows; ++k) {
      (*out)[k] += factor * (*s)[k];
      (*out)[rows + k] += factor * (*s)[std::min(k + 1, rows - 1)];
    }
  };
  add(with, per);
  add(without, -per);
  return out;
}

}  // namespace

bool SignalsOnly(const LinearModel& linear, const AxisModel& without, const AxisModel& with, double per,
                 LinearInput& input, SharedSignal& scale_error_m) {
  AxisModel same = with;
  same.motor_force = without.motor_force;
  same.load_force = without.load_force;
  same.level = without.level;
  same.viscous = without.viscous;
  same.reading_error = without.reading_error;
  same.scale_error_m = without.scale_error_m;
  if (same != without) return false;
  const std::size_t rows = linear.rows;
  input.motor_force = Difference(without.motor_force, with.motor_force, rows, per);
  input.load_force = Difference(without.load_force, with.load_force, rows, per);
  input.level = Difference(without.level, with.level, rows, per);
  input.reading_error = Difference(without.reading_error, with.reading_error, rows, per);
  scale_error_m = Difference(without.scale_error_m, with.scale_error_m, rows, per);
  const SharedSignal viscous = Difference(without.viscous, with.viscous, rows, per);
  if (viscous) {
    SharedSignal& force = linear.friction_on_load ? input.load_force : input.motor_force;
    if (force || viscous->size() != rows) return false;
    auto drag = std::make_shared<Signal>(rows);
    for (std::size_t k = 0; k < rows; ++k) (*drag)[k] = -linear.viscous * linear.velocity[k] * (*viscous)[k];
    force = drag;
  }
  return true;
}

}  // namespace contour::diagnosis
