#include "solvers/linear.hpp"

#include <klu.h>
#include <umfpack.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "golf/parallel.hpp"
#include "solvers/blas.hpp"
#include "solvers/errors.hpp"

namespace hosel::solvers {
namespace {

// What runs at once here is isolated: a thread that waits takes no other blow meanwhile.

void keep_once(std::vector<int>& list) {
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

SparseTangent::SparseTangent(const fem::System& system, Terms terms) : terms_(terms) {
  const auto n = static_cast<std::size_t>(system.dof_map.size());
  reduced_.assign(n, 0);
  for (const auto& p : system.prescribed)
    for (Index e : p->dofs()) reduced_[static_cast<std::size_t>(e)] = -1;
  for (std::size_t e = 0; e < n; ++e)
    if (reduced_[e] == 0) {
      reduced_[e] = static_cast<int>(free_.size());
      free_.push_back(static_cast<Index>(e));
    }
  std::vector<std::vector<Index>> blocks;
  for (const auto& term : system.terms)
    if (terms_ == Terms::all || !term->abrupt()) term->pattern(blocks);
  std::vector<std::vector<int>> columns(free_.size());
  for (std::size_t i = 0; i < free_.size(); ++i) columns[i].push_back(static_cast<int>(i));
  for (const auto& block : blocks)
    for (Index c : block) {
      const int column = reduced_.at(static_cast<std::size_t>(c));
      if (column < 0) continue;
      auto& list = columns[static_cast<std::size_t>(column)];
      for (Index r : block)
        if (const int row = reduced_[static_cast<std::size_t>(r)]; row >= 0) list.push_back(row);
      if (list.size() > 4096) keep_once(list);  // keeps the lists short while many blocks meet in one column
    }
  starts_.push_back(0);
  for_all_alone(std::size_t{0}, columns.size(), [&](std::size_t i) { keep_once(columns[i]); });
  for (const auto& list : columns) {
    rows_.insert(rows_.end(), list.begin(), list.end());
    starts_.push_back(static_cast<int>(rows_.size()));
  }
  values_.assign(rows_.size(), 0);
}

Vector SparseTangent::gather(const Vector& full) const {
  Vector out(size());
  for (Index i = 0; i < size(); ++i) out[i] = full[free_[static_cast<std::size_t>(i)]];
  return out;
}

void SparseTangent::scatter(const Vector& reduced, Vector& full) const {
  for (Index i = 0; i < size(); ++i) full[free_[static_cast<std::size_t>(i)]] = reduced[i];
}

void SparseTangent::assemble(const fem::System& system, const fem::State& trial, const fem::Weights& weights) {
  std::ranges::fill(values_, 0.0);
  turn_ = 0;
  for (const auto& term : system.terms)
    if (terms_ == Terms::all || !term->abrupt()) term->tangent(trial, weights, *this);
}

SparseTangent::Scatter SparseTangent::make_scatter(const std::vector<Index>& rows,
                                                   const std::vector<Index>& columns) const {
  Scatter s{rows, columns, {}};
  s.to.reserve(rows.size() * columns.size());
  for (Index c : columns) {
    const int column = reduced_[static_cast<std::size_t>(c)];
    for (Index r : rows) {
      const int row = reduced_[static_cast<std::size_t>(r)];
      if (column < 0 || row < 0) {
        s.to.push_back(-1);
        continue;
      }
      const auto first = rows_.begin() + starts_[static_cast<std::size_t>(column)];
      const auto last = rows_.begin() + starts_[static_cast<std::size_t>(column) + 1];
      const auto it = std::lower_bound(first, last, row);
      if (it == last || *it != row) throw std::logic_error("a term adds a tangent outside its pattern");
      s.to.push_back(static_cast<int>(it - rows_.begin()));
    }
  }
  return s;
}

void SparseTangent::add(const std::vector<Index>& rows, const std::vector<Index>& columns,
                        const Eigen::Ref<const Eigen::MatrixXd>& block) {
  if (turn_ == scatters_.size()) scatters_.push_back(make_scatter(rows, columns));
  Scatter& s = scatters_[turn_++];
  if (s.rows != rows || s.columns != columns) s = make_scatter(rows, columns);
  const int* to = s.to.data();
  for (Index j = 0; j < block.cols(); ++j)
    for (Index i = 0; i < block.rows(); ++i, ++to)
      if (*to >= 0) values_[static_cast<std::size_t>(*to)] += block(i, j);
}

void SparseTangent::add_all(const std::vector<std::vector<Index>>& equations,
                            const std::vector<Eigen::MatrixXd>& blocks) {
  const std::size_t first = turn_;
  turn_ += blocks.size();
  if (scatters_.size() < turn_) scatters_.resize(turn_);
  for_all_alone(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    Scatter& s = scatters_[first + b];
    if (s.rows != equations[b] || s.columns != equations[b]) s = make_scatter(equations[b], equations[b]);
  });
  constexpr Index slices = 8;
  for_all_alone(Index{0}, slices, [&](Index slice) {
    const Index from = size() * slice / slices, end = size() * (slice + 1) / slices;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (Index j = 0; j < blocks[b].cols(); ++j) {
        const int column = row(equations[b][static_cast<std::size_t>(j)]);
        if (column < from || column >= end) continue;
        const double* value = blocks[b].col(j).data();
        const int* to = scatters_[first + b].to.data() + j * blocks[b].rows();
        for (Index i = 0; i < blocks[b].rows(); ++i)
          if (to[i] >= 0) values_[static_cast<std::size_t>(to[i])] += value[i];
      }
  });
}

double SparseTangent::round_off(const fem::System& system, const fem::State& state) const {
  Vector size = Vector::Ones(system.dof_map.size());
  for (const auto& b : system.dof_map.blocks())
    if (!b.rotation) size.segment(b.v, b.size) = state.q.segment(b.q, b.size).cwiseAbs();
  Vector y = Vector::Zero(this->size());
  for (std::size_t c = 0; c < free_.size(); ++c)
    for (int k = starts_[c]; k < starts_[c + 1]; ++k)
      y[rows_[static_cast<std::size_t>(k)]] += std::abs(values_[static_cast<std::size_t>(k)]) * size[free_[c]];
  return 2 * std::numeric_limits<double>::epsilon() * y.norm();
}

Eigen::MatrixXd SparseTangent::dense() const {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(size(), size());
  for (std::size_t c = 0; c < free_.size(); ++c)
    for (int k = starts_[c]; k < starts_[c + 1]; ++k)
      m(rows_[static_cast<std::size_t>(k)], static_cast<Index>(c)) = values_[static_cast<std::size_t>(k)];
  return m;
}

struct Factorisation::State {
  void* symbolic = nullptr;  // of UMFPACK
  void* numeric = nullptr;
  klu_symbolic* chain = nullptr;  // of KLU, instead
  klu_numeric* chain_numeric = nullptr;
  klu_common chain_common{};
  const SparseTangent* matrix = nullptr;
  std::vector<double> values;  // as factorised: UMFPACK refines against them
  std::array<double, UMFPACK_CONTROL> control{};
  bool ready = false;

  State() { klu_defaults(&chain_common); }
  ~State() {
    forget_numbers();
    forget_order();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  void forget_numbers() {
    if (numeric) umfpack_di_free_numeric(&numeric);
    if (chain_numeric) klu_free_numeric(&chain_numeric, &chain_common);
    ready = false;
  }
  void forget_order() {
    if (symbolic) umfpack_di_free_symbolic(&symbolic);
    if (chain) klu_free_symbolic(&chain, &chain_common);
  }

  /// Factors with hardly any fill, as of a chain of beams, come faster without dense blocks: KLU. The bound is that
  /// at which CHOLMOD does without them (operations per entry of the factor).
  void order(int n, int* starts, int* rows) {
    constexpr double kDense = 40;
    chain = klu_analyze(n, starts, rows, &chain_common);
    if (chain && !(chain->est_flops >= 0 && chain->est_flops < kDense * chain->lnz))
      klu_free_symbolic(&chain, &chain_common);
    if (!chain && umfpack_di_symbolic(n, n, starts, rows, values.data(), &symbolic, control.data(), nullptr) < 0)
      throw NonConvergence("not enough memory to order the tangent matrix");
  }
  /// UMFPACK's status, also for KLU's.
  int factorise(int* starts, int* rows) {
    if (!chain) {
      if (numeric) umfpack_di_free_numeric(&numeric);
      return umfpack_di_numeric(starts, rows, values.data(), symbolic, &numeric, control.data(), nullptr);
    }
    // Pivots stay where they were until Newton's method gives up on them.
    if (chain_numeric && !klu_refactor(starts, rows, values.data(), chain, chain_numeric, &chain_common))
      klu_free_numeric(&chain_numeric, &chain_common);
    if (!chain_numeric) chain_numeric = klu_factor(starts, rows, values.data(), chain, &chain_common);
    return chain_numeric                              ? UMFPACK_OK
           : chain_common.status == KLU_OUT_OF_MEMORY ? UMFPACK_ERROR_out_of_memory
                                                      : UMFPACK_WARNING_singular_matrix;
  }
};

Factorisation::Factorisation() : state_(std::make_unique<State>()) {
  umfpack_di_defaults(state_->control.data());
  keep_blas_in_one_thread();
  // The patterns are symmetric; Newton's method is the refinement.
  state_->control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  state_->control[UMFPACK_IRSTEP] = 0;
}
Factorisation::~Factorisation() = default;
Factorisation::Factorisation(Factorisation&&) noexcept = default;
Factorisation& Factorisation::operator=(Factorisation&&) noexcept = default;

bool Factorisation::ready() const { return state_->ready; }

void Factorisation::forget() { state_->forget_numbers(); }

void Factorisation::factorise(const SparseTangent& matrix) {
  State& s = *state_;
  s.ready = false;
  // Both libraries ask for pointers that they do not write through.
  auto *starts = const_cast<int*>(matrix.column_starts().data()), *rows = const_cast<int*>(matrix.row_indices().data());
  s.values.assign(matrix.values().begin(), matrix.values().end());
  // Neither library looks: what is no number would pass for a singular matrix.
  if (!std::ranges::all_of(s.values, [](double x) { return std::isfinite(x); })) {
    forget();
    throw NonConvergence("the tangent matrix holds numbers that are not finite: some motion or stiffness overflows");
  }
  if (s.matrix != &matrix) {
    s.forget_numbers();
    s.forget_order();
    s.matrix = &matrix;
  }
  if (!s.symbolic && !s.chain) s.order(static_cast<int>(matrix.size()), starts, rows);
  const int status = s.factorise(starts, rows);
  s.ready = status == UMFPACK_OK;
  if (s.ready) return;
  forget();
  throw NonConvergence(
      status == UMFPACK_ERROR_out_of_memory
          ? "not enough memory to factorise the tangent matrix"
          : "the tangent matrix is singular: some body is held by nothing, or a mass or stiffness is zero");
}

Vector Factorisation::solve(const Vector& right) const {
  State& s = *state_;
  if (!s.ready) throw std::logic_error("solve before factorise");
  Vector x = right;
  const bool solved =
      s.chain ? klu_solve(s.chain, s.chain_numeric, static_cast<int>(x.size()), 1, x.data(), &s.chain_common) != 0
              : umfpack_di_solve(UMFPACK_A, s.matrix->column_starts().data(), s.matrix->row_indices().data(),
                                 s.values.data(), x.data(), right.data(), s.numeric, s.control.data(),
                                 nullptr) == UMFPACK_OK;
  if (!solved || !x.allFinite()) throw NonConvergence("the tangent matrix gave no finite solution");
  return x;
}

}  // namespace hosel::solvers
