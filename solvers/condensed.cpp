#include "solvers/condensed.hpp"

#include <cholmod.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "golf/parallel.hpp"
#include "solvers/blas.hpp"
#include "solvers/errors.hpp"

// CHOLMOD opens a team of four threads for every front, whatever the machine has: on fronts as small as ours their
// waking costs more than they do. Absent where CHOLMOD is built without OpenMP.
extern "C" void omp_set_max_active_levels(int) __attribute__((weak));
extern "C" int omp_get_max_active_levels(void) __attribute__((weak));

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

namespace {

/// No teams of threads on this one until the end of a scope: what calls us may want them.
class Alone {
 public:
  Alone() : before_(omp_get_max_active_levels && omp_set_max_active_levels ? omp_get_max_active_levels() : -1) {
    if (before_ >= 0) omp_set_max_active_levels(0);
  }
  ~Alone() {
    if (before_ >= 0) omp_set_max_active_levels(before_);
  }
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

 private:
  int before_;
};

[[noreturn]] void no_memory_to_order() { throw NonConvergence("not enough memory to order the tangent matrix"); }

/// Factors of some rows of the matrix among themselves.
class Part {
 public:
  Part() {
    keep_blas_in_one_thread();
    cholmod_start(&common_);
    common_.print = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_NATURAL;
    common_.postorder = 0;  // the kept rows stay last
    common_.supernodal = CHOLMOD_SUPERNODAL;
    common_.quick_return_if_not_posdef = 1;
  }
  ~Part() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_free_sparse(&lower_, &common_);
    cholmod_finish(&common_);
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  /// Ordering by constrained minimum degree of groups of rows with one pattern, those of `kept` last. `members` and
  /// `kept` mark rows of `a`. Throws NonConvergence where memory is short.
  void analyse(const SparseTangent& a, const std::vector<char>& members, const std::vector<char>& kept) {
    const auto n = static_cast<int>(a.size());
    const int *start = a.column_starts().data(), *row = a.row_indices().data();
    const auto marked = [](const std::vector<char>& marks, int i) { return marks[static_cast<std::size_t>(i)] != 0; };
    std::vector<int> group(static_cast<std::size_t>(n), -1);  // of each row
    std::vector<std::pair<int, int>> range;                   // of each group
    for (int j = 0; j < n; ++j) {
      if (!marked(members, j)) continue;
      const bool same = !range.empty() && range.back().second == j && marked(kept, j) == marked(kept, j - 1) &&
                        std::equal(row + start[j], row + start[j + 1], row + start[j - 1], row + start[j]);
      if (!same) range.emplace_back(j, j);
      range.back().second = j + 1;
      group[static_cast<std::size_t>(j)] = static_cast<int>(range.size()) - 1;
    }
    const std::size_t groups = range.size();
    std::vector<std::pair<int, int>> edges;
    for (std::size_t g = 0; g < groups; ++g) {
      const int j = range[g].first;
      for (int k = start[j]; k < start[j + 1]; ++k) {
        const int other = group[static_cast<std::size_t>(row[k])];
        if (other >= 0 && (edges.empty() || edges.back() != std::pair(static_cast<int>(g), other)))
          edges.emplace_back(static_cast<int>(g), other);
      }
    }
    // Symmetric, as its upper half states: a graph that is not would be ordered for its product with its transpose.
    cholmod_sparse* graph = cholmod_allocate_sparse(groups, groups, edges.size(), 1, 1, 1, CHOLMOD_PATTERN, &common_);
    if (!graph) no_memory_to_order();
    auto *gp = static_cast<int*>(graph->p), *gi = static_cast<int*>(graph->i);
    std::size_t e = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      gp[g] = static_cast<int>(e);
      for (; e < edges.size() && edges[e].first == static_cast<int>(g); ++e) gi[e] = edges[e].second;
    }
    gp[groups] = static_cast<int>(e);
    std::vector<int> last(groups), permuted(groups);
    for (std::size_t g = 0; g < groups; ++g) last[g] = marked(kept, range[g].first);
    const bool ordered = cholmod_camd(graph, nullptr, 0, last.data(), permuted.data(), &common_) != 0;
    cholmod_free_sparse(&graph, &common_);
    if (!ordered) no_memory_to_order();
    order_.clear();
    kept_ = 0;
    for (int g : permuted) {
      const auto [from, to] = range[static_cast<std::size_t>(g)];
      for (int j = from; j < to; ++j) order_.push_back(j);
      if (last[static_cast<std::size_t>(g)]) kept_ += to - from;
    }
    permute(a);
    cholmod_free_factor(&factor_, &common_);
    factor_ = cholmod_analyze(lower_, &common_);
    if (!factor_) no_memory_to_order();
  }

  /// False where the part is not positive definite. Throws NonConvergence where memory is short.
  bool factorise(const SparseTangent& a) {
    auto* x = static_cast<double*>(lower_->x);
    for (std::size_t q = 0; q < place_.size(); ++q) x[q] = a.values()[static_cast<std::size_t>(place_[q])];
    {
      const Alone alone;
      cholmod_factorize(lower_, factor_, &common_);
    }
    if (common_.status == CHOLMOD_OUT_OF_MEMORY)
      throw NonConvergence("not enough memory to factorise the tangent matrix");
    if (common_.status != CHOLMOD_OK) return false;
    read_root();
    const auto* values = static_cast<const double*>(factor_->x);
    single_.assign(values, values + factor_->xsize);
    return true;
  }

  const std::vector<int>& order() const { return order_; }  ///< row of each pivot
  Index size() const { return static_cast<Index>(order_.size()); }
  Index kept() const { return kept_; }
  const Eigen::MatrixXd& root() const { return root_; }  ///< the factor's last rows and columns
  std::size_t entries() const { return single_.size(); }
  double operations() const {
    double sum = 0;
    for (std::size_t s = 0; s < factor_->nsuper; ++s)
      for (Index j = 0, rows = front(s).values.rows(); j < front(s).columns; ++j) sum += std::pow(double(rows - j), 2);
    return sum;
  }

  /// Half of a solution, in place and in the order of the pivots: L x = b.
  void solve_lower(Eigen::Ref<Eigen::VectorXf> x) const {
    Eigen::VectorXf below;
    for (std::size_t s = 0; s < factor_->nsuper; ++s) {
      const auto front = this->front(s);
      auto own = x.segment(front.first, front.columns);
      front.values.topRows(front.columns).template triangularView<Eigen::Lower>().solveInPlace(own);
      below.noalias() = front.values.bottomRows(front.values.rows() - front.columns) * own;
      for (Index i = 0; i < below.size(); ++i) x[front.rows[front.columns + i]] -= below[i];
    }
  }
  /// The other: L^T x = b.
  void solve_upper(Eigen::Ref<Eigen::VectorXf> x) const {
    Eigen::VectorXf below;
    for (std::size_t s = factor_->nsuper; s-- > 0;) {
      const auto front = this->front(s);
      auto own = x.segment(front.first, front.columns);
      below.resize(front.values.rows() - front.columns);
      for (Index i = 0; i < below.size(); ++i) below[i] = x[front.rows[front.columns + i]];
      own.noalias() -= front.values.bottomRows(below.size()).transpose() * below;
      front.values.topRows(front.columns).template triangularView<Eigen::Lower>().transpose().solveInPlace(own);
    }
  }

 private:
  /// The lower triangle in the order of the pivots, so that CHOLMOD need not copy it again and again.
  void permute(const SparseTangent& a) {
    const auto n = order_.size();
    const auto start = a.column_starts(), row = a.row_indices();
    std::vector<int> pivot(static_cast<std::size_t>(a.size()), -1);
    for (std::size_t j = 0; j < n; ++j) pivot[static_cast<std::size_t>(order_[j])] = static_cast<int>(j);
    place_.clear();
    cholmod_free_sparse(&lower_, &common_);
    lower_ = cholmod_allocate_sparse(n, n, (row.size() + n) / 2, 0, 1, -1, CHOLMOD_REAL, &common_);
    if (!lower_) no_memory_to_order();
    auto *p = static_cast<int*>(lower_->p), *i = static_cast<int*>(lower_->i);
    for (std::size_t j = 0; j < n; ++j) {
      p[j] = static_cast<int>(place_.size());
      const auto column = static_cast<std::size_t>(order_[j]);
      for (int k = start[column]; k < start[column + 1]; ++k)
        if (const int at = pivot[static_cast<std::size_t>(row[static_cast<std::size_t>(k)])];
            at >= static_cast<int>(j)) {
          i[place_.size()] = at;
          place_.push_back(k);
        }
    }
    p[n] = static_cast<int>(place_.size());
  }

  /// Columns of the factor with one pattern.
  struct Front {
    Index first, columns;
    const int* rows;  // of the columns themselves, then those below
    Eigen::Map<const Eigen::MatrixXf> values;
  };
  Front front(std::size_t s) const {
    const auto *super = static_cast<const int*>(factor_->super), *pi = static_cast<const int*>(factor_->pi),
               *px = static_cast<const int*>(factor_->px), *rows = static_cast<const int*>(factor_->s);
    const Index columns = super[s + 1] - super[s];
    return {super[s], columns, rows + pi[s], {single_.data() + px[s], pi[s + 1] - pi[s], columns}};
  }

  void read_root() {
    const auto n = static_cast<int>(factor_->n), m = static_cast<int>(kept_);
    root_.setZero(m, m);
    const auto *super = static_cast<const int*>(factor_->super), *pi = static_cast<const int*>(factor_->pi),
               *px = static_cast<const int*>(factor_->px), *rows = static_cast<const int*>(factor_->s);
    const auto* x = static_cast<const double*>(factor_->x);
    for (std::size_t s = 0; s < factor_->nsuper; ++s)
      for (int j = std::max(super[s], n - m); j < super[s + 1]; ++j) {
        const int height = pi[s + 1] - pi[s];
        const double* column = x + px[s] + (j - super[s]) * height;
        for (int i = j - super[s]; i < height; ++i) root_(rows[pi[s] + i] - (n - m), j - (n - m)) = column[i];
      }
  }

  cholmod_common common_;
  cholmod_sparse* lower_ = nullptr;
  cholmod_factor* factor_ = nullptr;
  std::vector<int> order_, place_;  // place: entry of the tangent's values of each entry of `lower`
  Index kept_ = 0;
  Eigen::MatrixXd root_;
  std::vector<float> single_;  // the factor's values: solves wait for memory, and half as much comes twice as fast
};

}  // namespace

struct CondensedFactorisation::State {
  std::vector<std::unique_ptr<Part>> parts;
  std::vector<int> asked;         // the kept rows as they were asked for
  std::vector<int> kept, places;  // part after part; of each row among them
  Eigen::MatrixXd schur;
  bool ready = false;

  /// Works on the number of each part, at once where cores are free.
  template <class Work>
  void at_once(const Work& work) const {
    for_all_alone(std::size_t{0}, parts.size(), work);
  }

  /// Works on each part, with the first of its places among all rows and among the kept ones.
  template <class Work>
  void each(const Work& work) const {
    at_once([&](std::size_t i) {
      Index row = 0, kept_row = 0;
      for (std::size_t k = 0; k < i; ++k) row += parts[k]->size(), kept_row += parts[k]->kept();
      work(*parts[i], row, kept_row);
    });
  }

  void analyse(const SparseTangent& a, const std::vector<char>& apart) {
    const auto n = static_cast<std::size_t>(a.size());
    std::vector<char> last(n, 0);
    for (int k : asked) last[static_cast<std::size_t>(k)] = 1;
    std::vector<std::vector<char>> members;
    for (const char which : {0, 1}) {
      members.emplace_back(n);
      for (std::size_t i = 0; i < n; ++i) members.back()[i] = (apart.empty() ? 0 : apart[i]) == which;
      if (std::ranges::find(members.back(), 1) == members.back().end()) members.pop_back();
    }
    parts.clear();
    for (std::size_t i = 0; i < members.size(); ++i) parts.push_back(std::make_unique<Part>());
    at_once([&](std::size_t i) { parts[i]->analyse(a, members[i], last); });
    kept.clear();
    for (const auto& part : parts) kept.insert(kept.end(), part->order().end() - part->kept(), part->order().end());
    places.assign(n, -1);
    for (std::size_t i = 0; i < kept.size(); ++i) places[static_cast<std::size_t>(kept[i])] = static_cast<int>(i);
  }
};

CondensedFactorisation::CondensedFactorisation() : state_(std::make_unique<State>()) {}
CondensedFactorisation::~CondensedFactorisation() = default;
CondensedFactorisation::CondensedFactorisation(CondensedFactorisation&&) noexcept = default;
CondensedFactorisation& CondensedFactorisation::operator=(CondensedFactorisation&&) noexcept = default;

bool CondensedFactorisation::ready() const { return state_->ready; }
void CondensedFactorisation::forget() { state_->ready = false; }
std::span<const int> CondensedFactorisation::kept() const { return state_->kept; }
const std::vector<int>& CondensedFactorisation::places() const { return state_->places; }
const Eigen::MatrixXd& CondensedFactorisation::schur() const { return state_->schur; }

double CondensedFactorisation::operations() const {
  double sum = 0;
  for (const auto& part : state_->parts) sum += part->operations();
  return sum;
}

std::size_t CondensedFactorisation::entries() const {
  std::size_t sum = 0;
  for (const auto& part : state_->parts) sum += part->entries();
  return sum;
}

bool CondensedFactorisation::factorise(const SparseTangent& a, const std::vector<int>& kept,
                                       const std::vector<char>& apart) {
  State& s = *state_;
  s.ready = false;
  if (s.parts.empty() || kept != s.asked) {
    s.asked = kept;
    try {
      s.analyse(a, apart);
    } catch (...) {
      s.parts.clear();  // some of them may have no order
      throw;
    }
  }
  const auto m = static_cast<Index>(kept.size());
  s.schur.setZero(m, m);
  std::atomic<bool> good = true;
  s.each([&](Part& part, Index, Index at) {
    if (!part.factorise(a)) {
      good = false;
      return;
    }
    const Eigen::MatrixXd& root = part.root();
    s.schur.block(at, at, root.rows(), root.rows()).noalias() = root.triangularView<Eigen::Lower>() * root.transpose();
  });
  s.ready = good;
  return good;
}

Eigen::VectorXf CondensedFactorisation::eliminate(const Vector& right) const {
  Eigen::VectorXf y(right.size());
  state_->each([&](const Part& part, Index row, Index) {
    auto own = y.segment(row, part.size());
    for (Index i = 0; i < own.size(); ++i)
      own[i] = static_cast<float>(right[part.order()[static_cast<std::size_t>(i)]]);
    part.solve_lower(own);
  });
  return y;
}

Vector CondensedFactorisation::condensed(const Eigen::VectorXf& eliminated) const {
  Vector out(static_cast<Index>(state_->kept.size()));
  state_->each([&](const Part& part, Index row, Index at) {
    out.segment(at, part.kept()) = part.root().triangularView<Eigen::Lower>() *
                                   eliminated.segment(row + part.size() - part.kept(), part.kept()).cast<double>();
  });
  return out;
}

Vector CondensedFactorisation::recover(Eigen::VectorXf eliminated, const Vector& kept) const {
  Vector x(eliminated.size());
  state_->each([&](const Part& part, Index row, Index at) {
    auto own = eliminated.segment(row, part.size());
    const Vector root = part.root().triangularView<Eigen::Lower>().transpose() * kept.segment(at, part.kept());
    own.tail(part.kept()) = root.cast<float>();
    part.solve_upper(own);
    for (Index i = 0; i < own.size(); ++i) x[part.order()[static_cast<std::size_t>(i)]] = own[i];
  });
  if (!x.allFinite()) throw NonConvergence("the tangent matrix gave no finite solution");
  return x;
}

}  // namespace hosel::solvers
