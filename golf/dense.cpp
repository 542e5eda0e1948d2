// Eigen's heaviest templates for dynamic real matrices, compiled here once for the whole project.
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#define HOSEL_DENSE template
#include "dense_templates.hpp"
