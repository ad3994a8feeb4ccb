// SPDX-License-Identifier: BSD-3-Clause
#include "Kernel/Algebra/ConstrainedSolver.h"

#include "Kernel/Differential/Laplacian.h"
#include "RealMeshes.h"

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <limits>

using cartan::ConstrainedSolver;
using cartan::ErrorCode;
using cartan::Field;
using cartan::LaplacianWeights;
using cartan::SolverBackend;
using cartan::SparseMatrix;
using cartan::TriangleMesh;
using shapes::MakeMesh;
using shapes::Shape;

namespace
{
std::vector<SolverBackend> Backends()
{
  std::vector<SolverBackend> backends = { SolverBackend::Eigen };
  if (cartan::HasCholmod())
  {
    backends.push_back(SolverBackend::Cholmod);
  }
  return backends;
}

SparseMatrix GraphLaplacian(const TriangleMesh& mesh)
{
  return cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges()));
}

SparseMatrix CotangentLaplacian(const Shape& shape)
{
  const TriangleMesh mesh = MakeMesh(shape);
  return cartan::Laplacian(
    mesh, cartan::EdgeWeights(mesh, shape.Positions, LaplacianWeights::Cotangent));
}

Field RandomField(Eigen::Index rows, Eigen::Index columns, unsigned int seed)
{
  shapes::Random random(seed);
  return Field::NullaryExpr(rows, columns, [&random]() { return random(); });
}

std::vector<char> EveryFifth(Eigen::Index size)
{
  std::vector<char> isFixed(size, 0);
  for (Eigen::Index i = 0; i < size; i += 5)
  {
    isFixed[i] = 1;
  }
  return isFixed;
}

/// The same system in dense matrices.
Field SolveDensely(const SparseMatrix& matrix, const std::vector<char>& isFixed,
  const Eigen::VectorXd& stiffness, const Field& rightHandSide, const Field& values)
{
  Eigen::MatrixXd dense = matrix;
  Field b = rightHandSide;
  if (stiffness.size())
  {
    dense += Eigen::MatrixXd(stiffness.asDiagonal());
  }
  for (Eigen::Index i = 0; i < dense.rows(); ++i)
  {
    if (isFixed[i])
    {
      dense.row(i).setZero();
      dense(i, i) = 1.0;
      b.row(i) = values.row(i);
    }
  }
  return dense.fullPivLu().solve(Eigen::MatrixXd(b));
}

template <typename Call>
void ExpectError(ErrorCode code, const std::vector<std::string>& parts, const Call& call)
{
  try
  {
    call();
    FAIL() << "no error";
  }
  catch (const cartan::Error& error)
  {
    EXPECT_EQ(error.GetCode(), code);
    for (const std::string& part : parts)
    {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
        << "expected: " << part << "\nfound: " << error.what();
    }
  }
}
}

TEST(ConstrainedSolver, AgreesWithADenseSolve)
{
  const SparseMatrix matrix = CotangentLaplacian(shapes::Noisy(shapes::Torus(9, 8), 0.05));
  const std::vector<char> isFixed = EveryFifth(matrix.rows());
  const Field b = RandomField(matrix.rows(), 4, 1);
  const Field given = RandomField(matrix.rows(), 4, 2);
  const Field expected = SolveDensely(matrix, isFixed, {}, b, given);
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    EXPECT_EQ(solver.GetBackend(), backend);
    solver.Factorize(matrix, isFixed);
    Field values = given;
    solver.Solve(b, values);
    EXPECT_LT((values - expected).cwiseAbs().maxCoeff(), 1e-12);
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    {
      if (isFixed[i])
      {
        EXPECT_EQ(values.row(i), given.row(i)); // untouched, to the bit
      }
    }
  }
}

TEST(ConstrainedSolver, BackendsAgreeOnARealMesh)
{
  if (!cartan::HasCholmod())
  {
    GTEST_SKIP() << "built without CHOLMOD";
  }
  const SparseMatrix matrix = CotangentLaplacian(shapes::RealMesh("camel"));
  std::vector<char> isFixed(matrix.rows(), 0);
  isFixed[17] = 1;
  const Field b = RandomField(matrix.rows(), 3, 3);
  Field values[2];
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    solver.Factorize(matrix, isFixed);
    Field& x = values[backend == SolverBackend::Cholmod];
    x = Field::Zero(matrix.rows(), 3);
    solver.Solve(b, x);
  }
  const double difference =
    (values[0] - values[1]).cwiseAbs().maxCoeff() / values[0].cwiseAbs().maxCoeff();
  shapes::ShowFigure("Eigen - CHOLMOD, camel, one point fixed, relative", difference);
  EXPECT_LT(difference, 1e-10);
}

TEST(ConstrainedSolver, SoftRowsAreTheLeastSquaresSolution)
{
  // Minimize sum over edges |x_i - x_j|^2 + sum s_i |x_i - t_i|^2 as a
  // rectangular system by QR, which squares nothing.
  const Shape shape = shapes::Plane(5);
  const TriangleMesh mesh = MakeMesh(shape);
  const int size = mesh.NumberOfVertices();
  Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(size);
  stiffness[3] = 0.5;
  stiffness[20] = 7.0;
  stiffness[35] = 1e4;
  const Eigen::VectorXd target = RandomField(size, 1, 4);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(mesh.NumberOfEdges() + size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(rows.rows());
  int row = 0;
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    if (mesh.Origin(d) < mesh.Neighbor(d))
    {
      rows(row, mesh.Origin(d)) = 1.0;
      rows(row++, mesh.Neighbor(d)) = -1.0;
    }
  }
  for (int v = 0; v < size; ++v, ++row)
  {
    rows(row, v) = std::sqrt(stiffness[v]);
    right[row] = std::sqrt(stiffness[v]) * target[v];
  }
  const Eigen::VectorXd expected = rows.colPivHouseholderQr().solve(right);

  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    solver.Factorize(GraphLaplacian(mesh), std::vector<char>(size, 0), stiffness);
    Field values = Field::Zero(size, 1);
    solver.Solve(stiffness.cwiseProduct(target), values);
    EXPECT_LT((values - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(ConstrainedSolver, TakesFixedAndSoftTogether)
{
  const SparseMatrix matrix = CotangentLaplacian(shapes::Icosphere(1));
  const std::vector<char> isFixed = EveryFifth(matrix.rows());
  Eigen::VectorXd stiffness = RandomField(matrix.rows(), 1, 5).cwiseAbs();
  stiffness[1] = 0.0;
  const Field b = RandomField(matrix.rows(), 2, 6);
  const Field given = RandomField(matrix.rows(), 2, 7);
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    solver.Factorize(matrix, isFixed, stiffness);
    Field values = given;
    solver.Solve(b, values);
    EXPECT_LT((values - SolveDensely(matrix, isFixed, stiffness, b, given)).norm(), 1e-12);
  }
}

TEST(ConstrainedSolver, KeepsTheSymbolicFactorsWhileThePatternIsTheSame)
{
  const Shape shape = shapes::Torus(10, 7);
  const TriangleMesh mesh = MakeMesh(shape);
  const SparseMatrix uniform = GraphLaplacian(mesh);
  std::vector<char> isFixed = EveryFifth(uniform.rows());
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    const auto expect = [&solver](int factorizations, int analyses)
    {
      EXPECT_EQ(solver.GetNumberOfFactorizations(), factorizations);
      EXPECT_EQ(solver.GetNumberOfAnalyses(), analyses);
    };
    expect(0, 0);
    solver.Factorize(uniform, isFixed);
    expect(1, 1);
    solver.Factorize(CotangentLaplacian(shape), isFixed); // other values
    expect(2, 1);
    const Eigen::VectorXd stiffness = Eigen::VectorXd::Ones(uniform.rows());
    solver.Factorize(uniform, isFixed, stiffness); // another diagonal
    expect(3, 1);
    std::vector<char> others = isFixed;
    others[1] = 1;
    solver.Factorize(uniform, others); // other unknowns
    expect(4, 2);
    // As many unknowns and non-zeros, in another order.
    SparseMatrix permuted = uniform;
    Eigen::PermutationMatrix<Eigen::Dynamic> permutation(uniform.rows());
    permutation.setIdentity();
    std::swap(permutation.indices()[1], permutation.indices()[33]);
    permuted = permutation * uniform * permutation.transpose();
    solver.Factorize(permuted, others);
    expect(5, 3);

    // Whatever was kept, the last system is the one that is solved.
    const Field b = RandomField(uniform.rows(), 1, 8);
    Field values = Field::Zero(uniform.rows(), 1);
    solver.Solve(b, values);
    const Field zero = Field::Zero(uniform.rows(), 1);
    EXPECT_LT((values - SolveDensely(permuted, others, {}, b, zero)).norm(), 1e-11);
  }
}

TEST(ConstrainedSolver, SolvesManyRightHandSidesAsOneByOne)
{
  const SparseMatrix matrix = CotangentLaplacian(shapes::Plane(6, 1.0, 0.3));
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    solver.Factorize(matrix, EveryFifth(matrix.rows()));
    const Eigen::Index free = static_cast<Eigen::Index>(solver.GetFree().size());
    const Eigen::MatrixXd b = RandomField(free, 9, 9);
    const Eigen::MatrixXd together = solver.SolveFree(b);
    ASSERT_EQ(together.cols(), 9);
    for (int column = 0; column < 9; ++column)
    {
      EXPECT_LT((solver.SolveFree(b.col(column)) - together.col(column)).norm(), 1e-13);
    }
  }
}

TEST(ConstrainedSolver, WithAllUnknownsFixedChangesNothing)
{
  const SparseMatrix matrix = CotangentLaplacian(shapes::Icosphere(1));
  const Field given = RandomField(matrix.rows(), 3, 10);
  for (const SolverBackend backend : Backends())
  {
    // Also after a system that had unknowns, and before another one.
    ConstrainedSolver solver(backend);
    for (const bool isFirst : { true, false })
    {
      solver.Factorize(matrix, std::vector<char>(matrix.rows(), 1));
      EXPECT_TRUE(solver.GetFree().empty());
      Field values = given;
      solver.Solve(RandomField(matrix.rows(), 3, 11), values);
      EXPECT_EQ(values, given);
      solver.Factorize(matrix, EveryFifth(matrix.rows()));
      solver.Solve(Field::Zero(matrix.rows(), 3), values);
      EXPECT_LT(
        (values -
          SolveDensely(matrix, EveryFifth(matrix.rows()), {}, Field::Zero(matrix.rows(), 3), given))
          .norm(),
        1e-12)
        << isFirst;
    }
  }
}

TEST(ConstrainedSolver, WithNothingFixedNeedsAStiffness)
{
  const SparseMatrix matrix = CotangentLaplacian(shapes::Icosphere(1));
  const std::vector<char> isFixed(matrix.rows(), 0);
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    ExpectError(ErrorCode::SingularSystem,
      { "42 points (ids 0, 1, 2, 3, 4, ...)", "1 connected part", "Fix at least one point" },
      [&]() { solver.Factorize(matrix, isFixed); });
    Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(matrix.rows());
    ExpectError(ErrorCode::SingularSystem, { "42 points" },
      [&]() { solver.Factorize(matrix, isFixed, stiffness); });
    stiffness[12] = 1e-3;
    solver.Factorize(matrix, isFixed, stiffness);
    Field values = Field::Zero(matrix.rows(), 1);
    solver.Solve(2.0 * stiffness, values); // held at 2 in one place: constant
    EXPECT_LT((values.array() - 2.0).abs().maxCoeff(), 1e-9);
  }
}

TEST(ConstrainedSolver, NamesThePartsThatNothingHolds)
{
  const Shape shape =
    shapes::Union(shapes::Union(shapes::Icosphere(0), shapes::Icosphere(0)), shapes::Icosphere(0));
  const SparseMatrix matrix = CotangentLaplacian(shape); // three parts of 12
  std::vector<char> isFixed(36, 0);
  isFixed[13] = 1;
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    ExpectError(ErrorCode::SingularSystem,
      { "24 points (ids 0, 1, 2, 3, 4, ...)", "2 connected parts", "In each part" },
      [&]() { solver.Factorize(matrix, isFixed); });
    isFixed[0] = 1;
    ExpectError(ErrorCode::SingularSystem,
      { "12 points (ids 24, 25, 26, 27, 28, ...)", "1 connected part" },
      [&]() { solver.Factorize(matrix, isFixed); });

    // Several unknowns of one vertex count once.
    std::vector<int> vertices(36);
    for (int i = 0; i < 36; ++i)
    {
      vertices[i] = 100 + i / 3;
    }
    ExpectError(ErrorCode::SingularSystem, { "4 points (ids 108, 109, 110, 111)" },
      [&]() { solver.Factorize(matrix, isFixed, {}, vertices); });

    isFixed[30] = 1;
    EXPECT_NO_THROW(solver.Factorize(matrix, isFixed));
    isFixed[0] = isFixed[30] = 0;
  }
}

TEST(ConstrainedSolver, IsNotConnectedByEntriesThatAreZero)
{
  std::vector<Eigen::Triplet<double>> entries = { { 0, 0, 1.0 }, { 1, 1, 1.0 }, { 0, 1, 0.0 },
    { 1, 0, 0.0 }, { 2, 2, 0.0 } };
  SparseMatrix matrix(3, 3);
  matrix.setFromTriplets(entries.begin(), entries.end());
  ConstrainedSolver solver;
  ExpectError(ErrorCode::SingularSystem, { "2 points (ids 1, 2)", "2 connected parts" },
    [&]() {
      solver.Factorize(matrix, { 1, 0, 0 });
    });
}

TEST(ConstrainedSolver, NamesAPointInSeveralPartsOnce)
{
  SparseMatrix matrix(4, 4);
  matrix.setIdentity();
  ConstrainedSolver solver;
  ExpectError(ErrorCode::SingularSystem, { "2 points (ids 7, 8)", "4 connected parts" },
    [&]() {
      solver.Factorize(matrix, { 0, 0, 0, 0 }, {}, { 7, 8, 7, 8 });
    });
}

TEST(ConstrainedSolver, RefusesAMatrixThatIsNotPositiveAndWorksAfterwards)
{
  const SparseMatrix good = CotangentLaplacian(shapes::Icosphere(1));
  const SparseMatrix bad = -1.0 * good;
  const std::vector<char> isFixed = EveryFifth(good.rows());
  const Field given = RandomField(good.rows(), 1, 12);
  const Field zero = Field::Zero(good.rows(), 1);
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    ExpectError(ErrorCode::NotPositiveDefinite, { "33 unknowns", "cannot be factorized" },
      [&]() { solver.Factorize(bad, isFixed); });
    SparseMatrix notFinite = good;
    notFinite.coeffRef(1, 1) = std::numeric_limits<double>::quiet_NaN();
    ExpectError(ErrorCode::NotPositiveDefinite, {},
      [&]()
      {
        solver.Factorize(notFinite, isFixed);
        solver.SolveFree(Eigen::MatrixXd::Ones(33, 1));
      });
    solver.Factorize(good, isFixed);
    Field values = given;
    solver.Solve(zero, values);
    EXPECT_LT((values - SolveDensely(good, isFixed, {}, zero, given)).norm(), 1e-12);
  }
}

TEST(ConstrainedSolver, NeverReturnsNumbersThatAreNotFinite)
{
  const SparseMatrix matrix = CotangentLaplacian(shapes::Icosphere(1));
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    solver.Factorize(matrix, EveryFifth(matrix.rows()));
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(33, 2);
    b(3, 1) = std::numeric_limits<double>::infinity();
    ExpectError(
      ErrorCode::NotPositiveDefinite, { "no finite solution" }, [&]() { solver.SolveFree(b); });
  }
}

TEST(ConstrainedSolver, StopsOnRequestAndWorksAfterwards)
{
  const SparseMatrix matrix = CotangentLaplacian(shapes::Icosphere(2));
  const std::vector<char> isFixed = EveryFifth(matrix.rows());
  const Field given = RandomField(matrix.rows(), 1, 13);
  const Field zero = Field::Zero(matrix.rows(), 1);
  for (const SolverBackend backend : Backends())
  {
    ConstrainedSolver solver(backend);
    // Every report is a place to stop.
    for (int stopAt = 1;; ++stopAt)
    {
      int reports = 0;
      const cartan::ExecutionContext context(
        {}, [&reports, stopAt](double) { return ++reports != stopAt; });
      try
      {
        solver.Factorize(matrix, isFixed, {}, {}, context);
        EXPECT_GT(stopAt, 2) << "there was nothing to stop";
        break;
      }
      catch (const cartan::Error& error)
      {
        EXPECT_EQ(error.GetCode(), ErrorCode::Aborted);
      }
    }
    solver.Factorize(matrix, isFixed);
    Field values = given;
    solver.Solve(zero, values);
    EXPECT_LT((values - SolveDensely(matrix, isFixed, {}, zero, given)).norm(), 1e-11);
  }
}

TEST(ConstrainedSolver, MayBeMoved)
{
  const SparseMatrix matrix = CotangentLaplacian(shapes::Icosphere(1));
  ConstrainedSolver first;
  first.Factorize(matrix, EveryFifth(matrix.rows()));
  const Eigen::MatrixXd b = Eigen::MatrixXd::Ones(33, 1);
  const Eigen::MatrixXd expected = first.SolveFree(b);
  const ConstrainedSolver second(std::move(first));
  EXPECT_EQ(second.SolveFree(b), expected);
}

TEST(ConstrainedSolver, ChoosesCholmodWhenItIsThere)
{
  EXPECT_EQ(ConstrainedSolver().GetBackend(),
    cartan::HasCholmod() ? SolverBackend::Cholmod : SolverBackend::Eigen);
  if (!cartan::HasCholmod())
  {
    ExpectError(ErrorCode::BadInput, { "without CHOLMOD", "Eigen" },
      []() { ConstrainedSolver solver(SolverBackend::Cholmod); });
  }
}
