#include "hosel/solvers/condensed.hpp"

#include <cholmod.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "hosel/solvers/errors.hpp"

// CHOLMOD opens a team of four threads for every front, whatever the machine has: on fronts as small as ours their
// waking costs more than they do. Absent where CHOLMOD is built without OpenMP.
extern "C" void omp_set_max_active_levels(int) __attribute__((weak));

namespace hosel::solvers {

void DenseTangent::add(const std::vector<Index>& rows, const std::vector<Index>& columns,
                       const Eigen::Ref<const Eigen::MatrixXd>& block) {
  Block& b = blocks_.emplace_back();
  for (Index r : rows) b.rows.push_back(rows_.row(r));
  for (Index c : columns) b.columns.push_back(rows_.row(c));
  b.values = block;
}

std::vector<int> DenseTangent::touched() const {
  std::vector<int> out;
  for (const Block& b : blocks_)
    for (const auto* list : {&b.rows, &b.columns})
      for (int r : *list)
        if (r >= 0) out.push_back(r);
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Eigen::MatrixXd DenseTangent::on(const std::vector<int>& places, Index kept) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kept, kept);
  const auto place = [&](int row) { return row < 0 ? -1 : places[static_cast<std::size_t>(row)]; };
  std::vector<int> rows;
  for (const Block& b : blocks_) {
    rows.clear();
    for (int r : b.rows) rows.push_back(place(r));
    for (std::size_t j = 0; j < b.columns.size(); ++j)
      if (const int column = place(b.columns[j]); column >= 0)
        for (std::size_t i = 0; i < rows.size(); ++i)
          if (rows[i] >= 0) out(rows[i], column) += b.values(static_cast<Index>(i), static_cast<Index>(j));
  }
  return out;
}

struct CondensedFactorisation::State {
  cholmod_common common;
  cholmod_sparse* lower = nullptr;
  cholmod_factor* factor = nullptr;
  std::vector<int> kept, order;  // order: row of each pivot
  std::vector<int> place;        // entry of the tangent's values of each entry of `lower`
  bool ready = false;
  std::vector<int> places;      // of each row among the kept, in the order of the pivots
  Eigen::MatrixXd root, schur;  // L of the kept rows; L L^T

  State() {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder = 0;  // the kept rows stay last
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.quick_return_if_not_posdef = 1;
  }
  ~State() {
    cholmod_free_factor(&factor, &common);
    cholmod_free_sparse(&lower, &common);
    cholmod_finish(&common);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Ordering by constrained minimum degree of groups of rows with one pattern, the kept ones last.
  void analyse(const SparseTangent& a) {
    const auto n = static_cast<int>(a.size());
    const int *start = a.column_starts().data(), *row = a.row_indices().data();
    std::vector<char> last(static_cast<std::size_t>(n), 0);
    for (int k : kept) last[static_cast<std::size_t>(k)] = 1;
    std::vector<int> group, first;  // of each row; of each group
    for (int j = 0; j < n; ++j) {
      const bool same = j > 0 && last[static_cast<std::size_t>(j)] == last[static_cast<std::size_t>(j) - 1] &&
                        std::equal(row + start[j], row + start[j + 1], row + start[j - 1], row + start[j]);
      if (!same) first.push_back(j);
      group.push_back(static_cast<int>(first.size()) - 1);
    }
    const std::size_t groups = first.size();
    std::vector<std::pair<int, int>> edges;
    for (std::size_t g = 0; g < groups; ++g) {
      const int j = first[g];
      for (int k = start[j]; k < start[j + 1]; ++k) {
        const int other = group[static_cast<std::size_t>(row[k])];
        if (edges.empty() || edges.back() != std::pair(static_cast<int>(g), other))
          edges.emplace_back(static_cast<int>(g), other);
      }
    }
    cholmod_sparse* graph = cholmod_allocate_sparse(groups, groups, edges.size(), 1, 1, 0, CHOLMOD_PATTERN, &common);
    auto *gp = static_cast<int*>(graph->p), *gi = static_cast<int*>(graph->i);
    std::size_t e = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      gp[g] = static_cast<int>(e);
      for (; e < edges.size() && edges[e].first == static_cast<int>(g); ++e) gi[e] = edges[e].second;
    }
    gp[groups] = static_cast<int>(e);
    std::vector<int> member(groups), permuted(groups);
    for (std::size_t g = 0; g < groups; ++g) member[g] = last[static_cast<std::size_t>(first[g])];
    cholmod_camd(graph, nullptr, 0, member.data(), permuted.data(), &common);
    cholmod_free_sparse(&graph, &common);
    first.push_back(n);
    order.clear();
    for (int g : permuted)
      for (int j = first[static_cast<std::size_t>(g)]; j < first[static_cast<std::size_t>(g) + 1]; ++j)
        order.push_back(j);

    permute(a);
    cholmod_free_factor(&factor, &common);
    factor = cholmod_analyze(lower, &common);
  }

  /// The lower triangle in the order of the pivots, so that CHOLMOD need not copy it again and again.
  void permute(const SparseTangent& a) {
    const auto n = order.size();
    const auto start = a.column_starts(), row = a.row_indices();
    std::vector<int> pivot(n);
    for (std::size_t j = 0; j < n; ++j) pivot[static_cast<std::size_t>(order[j])] = static_cast<int>(j);
    place.clear();
    cholmod_free_sparse(&lower, &common);
    lower = cholmod_allocate_sparse(n, n, (row.size() + n) / 2, 0, 1, -1, CHOLMOD_REAL, &common);
    auto *p = static_cast<int*>(lower->p), *i = static_cast<int*>(lower->i);
    for (std::size_t j = 0; j < n; ++j) {
      p[j] = static_cast<int>(place.size());
      const auto column = static_cast<std::size_t>(order[j]);
      for (int k = start[column]; k < start[column + 1]; ++k)
        if (const int at = pivot[static_cast<std::size_t>(row[static_cast<std::size_t>(k)])];
            at >= static_cast<int>(j)) {
          i[place.size()] = at;
          place.push_back(k);
        }
    }
    p[n] = static_cast<int>(place.size());
  }

  void read_values(const SparseTangent& a) {
    auto* x = static_cast<double*>(lower->x);
    for (std::size_t q = 0; q < place.size(); ++q) x[q] = a.values()[static_cast<std::size_t>(place[q])];
  }

  /// The factor's last rows and columns.
  void read_root() {
    const auto n = static_cast<int>(factor->n), m = static_cast<int>(kept.size());
    root.setZero(m, m);
    const auto *super = static_cast<const int*>(factor->super), *pi = static_cast<const int*>(factor->pi),
               *px = static_cast<const int*>(factor->px), *rows = static_cast<const int*>(factor->s);
    const auto* x = static_cast<const double*>(factor->x);
    for (std::size_t s = 0; s < factor->nsuper; ++s)
      for (int j = std::max(super[s], n - m); j < super[s + 1]; ++j) {
        const int height = pi[s + 1] - pi[s];
        const double* column = x + px[s] + (j - super[s]) * height;
        for (int i = j - super[s]; i < height; ++i) root(rows[pi[s] + i] - (n - m), j - (n - m)) = column[i];
      }
    schur.setZero(m, m);
    schur.noalias() = root.triangularView<Eigen::Lower>() * root.transpose();
  }

  Vector half_solve(int system, Vector right) const {
    cholmod_dense b{};
    b.nrow = b.d = b.nzmax = static_cast<std::size_t>(right.size());
    b.ncol = 1;
    b.x = right.data();
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    auto* shared = const_cast<cholmod_common*>(&common);  // holds workspace and counts
    cholmod_dense* x = cholmod_solve(system, factor, &b, shared);
    right = Eigen::Map<const Vector>(static_cast<const double*>(x->x), right.size());
    cholmod_free_dense(&x, shared);
    return right;
  }
};

CondensedFactorisation::CondensedFactorisation() : state_(std::make_unique<State>()) {}
CondensedFactorisation::~CondensedFactorisation() = default;
CondensedFactorisation::CondensedFactorisation(CondensedFactorisation&&) noexcept = default;
CondensedFactorisation& CondensedFactorisation::operator=(CondensedFactorisation&&) noexcept = default;

bool CondensedFactorisation::ready() const { return state_->ready; }
void CondensedFactorisation::forget() { state_->ready = false; }
std::span<const int> CondensedFactorisation::kept() const { return std::span(state_->order).last(state_->kept.size()); }
const std::vector<int>& CondensedFactorisation::places() const { return state_->places; }
const Eigen::MatrixXd& CondensedFactorisation::schur() const { return state_->schur; }

bool CondensedFactorisation::factorise(const SparseTangent& a, const std::vector<int>& kept) {
  State& s = *state_;
  s.ready = false;
  if (!s.factor || kept != s.kept) {
    s.kept = kept;
    s.analyse(a);
    s.places.assign(s.order.size(), -1);
    for (std::size_t i = 0; i < kept.size(); ++i)
      s.places[static_cast<std::size_t>(s.order[s.order.size() - kept.size() + i])] = static_cast<int>(i);
  }
  s.read_values(a);
  if (omp_set_max_active_levels) omp_set_max_active_levels(0);
  cholmod_factorize(s.lower, s.factor, &s.common);
  if (s.common.status == CHOLMOD_OUT_OF_MEMORY)
    throw NonConvergence("not enough memory to factorise the tangent matrix");
  if (s.common.status != CHOLMOD_OK) return false;
  s.read_root();
  s.ready = true;
  return true;
}

Vector CondensedFactorisation::eliminate(const Vector& right) const {
  const State& s = *state_;
  Vector y(right.size());
  for (Index i = 0; i < y.size(); ++i) y[i] = right[s.order[static_cast<std::size_t>(i)]];
  return s.half_solve(CHOLMOD_L, std::move(y));
}

Vector CondensedFactorisation::condensed(const Vector& eliminated) const {
  return state_->root.triangularView<Eigen::Lower>() * eliminated.tail(state_->root.rows());
}

Vector CondensedFactorisation::recover(Vector eliminated, const Vector& kept) const {
  const State& s = *state_;
  eliminated.tail(kept.size()) = s.root.triangularView<Eigen::Lower>().transpose() * kept;
  const Vector y = s.half_solve(CHOLMOD_Lt, std::move(eliminated));
  Vector x(y.size());
  for (Index i = 0; i < y.size(); ++i) x[s.order[static_cast<std::size_t>(i)]] = y[i];
  if (!x.allFinite()) throw NonConvergence("the tangent matrix gave no finite solution");
  return x;
}

}  // namespace hosel::solvers
