// Eigen's products and factorisations of dynamic real matrices: HOSEL_DENSE is `extern template` where they are used
// and `template` in the one file that holds them.
namespace Eigen::internal {
using HoselGebp = gebp_traits<double, double>;
using HoselMapper = blas_data_mapper<double, Index, ColMajor>;
using HoselConstColumns = const_blas_data_mapper<double, Index, ColMajor>;
using HoselConstRows = const_blas_data_mapper<double, Index, RowMajor>;
HOSEL_DENSE struct gebp_kernel<double, double, Index, HoselMapper, HoselGebp::mr, HoselGebp::nr, false, false>;
HOSEL_DENSE struct general_matrix_matrix_product<Index, double, ColMajor, false, double, ColMajor, false, ColMajor, 1>;
HOSEL_DENSE struct general_matrix_matrix_product<Index, double, RowMajor, false, double, ColMajor, false, ColMajor, 1>;
HOSEL_DENSE struct general_matrix_matrix_product<Index, double, ColMajor, false, double, RowMajor, false, ColMajor, 1>;
HOSEL_DENSE struct general_matrix_matrix_product<Index, double, RowMajor, false, double, RowMajor, false, ColMajor, 1>;
HOSEL_DENSE struct general_matrix_vector_product<Index, double, HoselConstColumns, ColMajor, false, double,
                                                 HoselConstRows, false, 0>;
HOSEL_DENSE struct general_matrix_vector_product<Index, double, HoselConstRows, RowMajor, false, double,
                                                 HoselConstColumns, false, 0>;
HOSEL_DENSE struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>;
HOSEL_DENSE struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;
HOSEL_DENSE struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor, ColMajor, 1>;
HOSEL_DENSE struct triangular_solve_vector<double, double, Index, OnTheLeft, Lower, false, ColMajor>;
HOSEL_DENSE struct triangular_solve_vector<double, double, Index, OnTheLeft, Upper, false, ColMajor>;
HOSEL_DENSE struct triangular_solve_vector<double, double, Index, OnTheLeft, UnitLower, false, ColMajor>;
}  // namespace Eigen::internal
namespace Eigen {
HOSEL_DENSE class JacobiSVD<MatrixXd>;
HOSEL_DENSE class ColPivHouseholderQR<MatrixXd>;
HOSEL_DENSE class HouseholderQR<MatrixXd>;
HOSEL_DENSE class SelfAdjointEigenSolver<MatrixXd>;
HOSEL_DENSE class GeneralizedSelfAdjointEigenSolver<MatrixXd>;
HOSEL_DENSE class PartialPivLU<MatrixXd>;
HOSEL_DENSE class LLT<MatrixXd>;
HOSEL_DENSE class LDLT<MatrixXd>;
HOSEL_DENSE class SelfAdjointEigenSolver<Matrix3d>;
}  // namespace Eigen
