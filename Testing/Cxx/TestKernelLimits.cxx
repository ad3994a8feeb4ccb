// SPDX-License-Identifier: BSD-3-Clause
// What does not fit into indices, memory or steps is refused, with the code that
// says which.
#include "AllDeformers.h"
#include "RealMeshes.h"

#include "Kernel/Algebra/Rotation.h"
#include "Kernel/Algebra/SparseProduct.h"
#include "Kernel/Algebra/SymmetricSolver.h"
#include "Kernel/Differential/FrameReconstruction.h"
#include "Kernel/Differential/Laplacian.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <type_traits>

#ifdef CARTAN_HAVE_CHOLMOD
#include <SuiteSparse_config.h>
#endif

namespace
{
using cartan::Error;
using cartan::ErrorCode;
using cartan::HandleProblem;
using cartan::LowerEntryLimit;
using cartan::SolverStatus;
using cartan::SparseMatrix;
using cartan::TriangleMesh;

/// A bar with its ends as handles: 1 pinned, 2 moving.
HandleProblem BarProblem()
{
  const shapes::Shape bar = shapes::Bar(3, 3, 12, { 1.0, 1.0, 4.0 });
  HandleProblem problem;
  problem.Mesh = std::make_shared<TriangleMesh>(shapes::MakeMesh(bar));
  problem.Rest = std::make_shared<cartan::Points>(bar.Positions);
  for (int v = 0; v < bar.NumberOfVertices(); ++v)
  {
    const double z = bar.Positions(v, 2);
    problem.Handle.push_back(z < 0.4 ? 1 : z > 3.6 ? 2 : 0);
  }
  problem.Moving = { 2 };
  return problem;
}

/// The code and the text of what an action throws.
template <typename Action>
std::pair<ErrorCode, std::string> Thrown(const Action& action)
{
  try
  {
    action();
  }
  catch (const Error& error)
  {
    return { error.GetCode(), error.what() };
  }
  return { ErrorCode::Aborted, "nothing" };
}

template <typename Action>
void ExpectTooLarge(std::int64_t limit, const std::string& what, const Action& action)
{
  const LowerEntryLimit lower(limit);
  const auto [code, text] = Thrown(action);
  EXPECT_EQ(code, ErrorCode::TooLarge) << text;
  EXPECT_EQ(text.rfind(what + " has ", 0), 0u) << text;
  EXPECT_NE(text.find(std::to_string(limit)), std::string::npos) << text;
}
}

TEST(EntryLimit, IsThatOfIndicesAndComesBack)
{
  EXPECT_EQ(cartan::GetEntryLimit(), 2147483647);
  {
    const LowerEntryLimit lower(7);
    EXPECT_EQ(cartan::GetEntryLimit(), 7);
    EXPECT_NO_THROW(cartan::RequireIndexable(7, "The system"));
    EXPECT_THROW(cartan::RequireIndexable(8, "The system"), Error);
  }
  EXPECT_EQ(cartan::GetEntryLimit(), 2147483647);
}

TEST(EntryLimit, HoldsForTheSystemOfTheFrames)
{
  const shapes::Shape sphere = shapes::Icosphere(2);
  const TriangleMesh mesh = shapes::MakeMesh(sphere);
  const auto transitions =
    cartan::TransitionsFromFrames(mesh, cartan::VertexFrames(mesh, sphere.Positions));
  const std::int64_t entries = 9 * (mesh.NumberOfDirectedEdges() + mesh.NumberOfVertices());
  {
    const LowerEntryLimit lower(entries);
    EXPECT_EQ(cartan::FrameMatrix(mesh, transitions).nonZeros(), entries);
  }
  ExpectTooLarge(
    entries - 1, "The system of the frames", [&] { cartan::FrameMatrix(mesh, transitions); });
}

TEST(EntryLimit, HoldsForEachSystemOfTheMethods)
{
  const HandleProblem problem = BarProblem();
  const auto makers = deformers::All();
  const auto prepare = [&](const std::string& name)
  { return [&, name] { makers.at(name)(problem, {}); }; };
  // Between the entries of the Laplacian and those of the products.
  const std::int64_t limit = 10 * problem.Mesh->NumberOfVertices();
  ExpectTooLarge(limit, "The system of order 2", prepare("LaplacianNone"));
  ExpectTooLarge(limit, "The system of order 2", prepare("Multiresolution2"));
  ExpectTooLarge(limit, "The normal system", prepare("SimilarityEdgeForm"));
  const std::int64_t above = 25 * problem.Mesh->NumberOfVertices();
  EXPECT_NO_THROW(prepare("Multiresolution2")());
  ExpectTooLarge(above, "The system of order 3", prepare("Multiresolution3"));
  ExpectTooLarge(above, "The system of implicit rotations", prepare("LaplacianImplicit"));
  for (const auto& [name, make] : makers)
  {
    EXPECT_NO_THROW(make(problem, {})) << name;
  }
}

TEST(EntryLimit, CountsTheNormalSystemExactly)
{
  // Just as many as there are pass, one less does not.
  const HandleProblem problem = BarProblem();
  const auto make = deformers::All().at("SimilarityAffine");
  std::int64_t low = 1;
  std::int64_t high = 1000 * problem.Mesh->NumberOfVertices();
  while (low < high)
  {
    const std::int64_t middle = (low + high) / 2;
    const LowerEntryLimit lower(middle);
    (Thrown([&] { make(problem, {}); }).first == ErrorCode::TooLarge ? low : high) =
      middle + (Thrown([&] { make(problem, {}); }).first == ErrorCode::TooLarge ? 1 : 0);
  }
  const LowerEntryLimit lower(low - 1);
  const auto [code, text] = Thrown([&] { make(problem, {}); });
  EXPECT_EQ(code, ErrorCode::TooLarge);
  EXPECT_NE(text.find(" has " + std::to_string(low) + " entries"), std::string::npos) << text;
}

TEST(EigenFactor, CountsTheEntriesBeforeItFindsThePattern)
{
  const shapes::Shape sphere = shapes::Icosphere(3);
  const TriangleMesh mesh = shapes::MakeMesh(sphere);
  SparseMatrix matrix =
    cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges()));
  matrix.diagonal().array() += 0.1;
  const SparseMatrix lower = matrix.triangularView<Eigen::Lower>();
  const auto narrow = cartan::MakeSymmetricSolver(cartan::SolverBackend::Eigen);
  ASSERT_EQ(narrow->Analyze(lower), SolverStatus::Ok);
  ASSERT_EQ(narrow->Factorize(lower), SolverStatus::Ok);
  const std::int64_t entries = narrow->GetNumberOfEntries();
  // L itself, with the space of its values and its indices.
  EXPECT_GE(narrow->GetBytes(), 12 * static_cast<std::size_t>(entries));
  EXPECT_LT(narrow->GetBytes(), 13 * static_cast<std::size_t>(entries));

  // One entry less than L has: wide indices; the ordering still fits into narrow ones.
  ASSERT_GT(entries - 1, 2 * lower.nonZeros() / 5 * 6 + 2 * lower.cols());
  cartan::FactorLimits limits;
  limits.NarrowEntries = entries - 1;
  const auto wide = cartan::MakeSymmetricSolver(cartan::SolverBackend::Eigen, limits);
  ASSERT_EQ(wide->Analyze(lower), SolverStatus::Ok);
  ASSERT_EQ(wide->Factorize(lower), SolverStatus::Ok);
  EXPECT_EQ(wide->GetNumberOfEntries(), entries);
  EXPECT_GE(wide->GetBytes(), 16 * static_cast<std::size_t>(entries));
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(lower.rows(), 3);
  ASSERT_EQ(wide->Solve(right), SolverStatus::Ok);
  EXPECT_LT((matrix * wide->GetSolution() - right).norm(), 1e-11);

  // What cannot be counted in any index, or not kept, is not begun.
  limits.Entries = entries - 1;
  EXPECT_EQ(cartan::MakeSymmetricSolver(cartan::SolverBackend::Eigen, limits)->Analyze(lower),
    SolverStatus::OutOfMemory);
}

TEST(SolveFramesFrom, SaysThatItDidNotConverge)
{
  const shapes::Shape sphere = shapes::Icosphere(2);
  const TriangleMesh mesh = shapes::MakeMesh(sphere);
  const cartan::Matrices frames = cartan::VertexFrames(mesh, sphere.Positions);
  auto transitions = cartan::TransitionsFromFrames(mesh, frames);
  shapes::Random random(6);
  for (int d = 0; d < mesh.NumberOfDirectedEdges(); ++d)
  {
    const Eigen::Vector3d turn{ random(), random(), random() };
    cartan::MatrixAt(transitions, d) =
      (cartan::MatrixAt(transitions, d) * cartan::RotationFromVector(0.3 * turn)).eval();
  }
  std::vector<char> isFixed(mesh.NumberOfVertices(), 0);
  isFixed[0] = 1;
  cartan::AnchoredSystem laplacian;
  laplacian.Factorize(cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges())),
    cartan::Anchors::Hard(isFixed));
  int steps = 0;
  const auto solve = [&](int maximum)
  {
    return cartan::SolveFramesFrom(
      mesh, transitions, isFixed, frames, laplacian, &steps, {}, {}, maximum);
  };
  solve(1000);
  ASSERT_GT(steps, 3);
  const int needed = steps;
  EXPECT_NO_THROW(solve(needed));
  const auto [code, text] = Thrown([&] { solve(needed - 1); });
  EXPECT_EQ(code, ErrorCode::NotConverged);
  EXPECT_NE(text.find("after " + std::to_string(needed - 1) + " steps"), std::string::npos);
  EXPECT_NE(text.find("FrameSolver"), std::string::npos);
}

#ifdef CARTAN_HAVE_CHOLMOD
namespace
{
int allocationsLeft = 0;

void* Allocate(std::size_t size)
{
  return allocationsLeft-- > 0 ? std::malloc(size) : nullptr;
}
void* AllocateZeros(std::size_t count, std::size_t size)
{
  return allocationsLeft-- > 0 ? std::calloc(count, size) : nullptr;
}
void* Reallocate(void* old, std::size_t size)
{
  return allocationsLeft-- > 0 ? std::realloc(old, size) : nullptr;
}

/// While it lives, CHOLMOD gets so many pieces of memory.
class LimitedAllocations
{
public:
  explicit LimitedAllocations(int count)
  {
    allocationsLeft = count;
    SuiteSparse_config.malloc_func = Allocate;
    SuiteSparse_config.calloc_func = AllocateZeros;
    SuiteSparse_config.realloc_func = Reallocate;
  }
  ~LimitedAllocations() { SuiteSparse_config = this->Before; }

private:
  SuiteSparse_config_struct Before = SuiteSparse_config;
};
}

TEST(CholmodFactor, SaysWhenTheMemoryDoesNotSuffice)
{
  const shapes::Shape sphere = shapes::Icosphere(2);
  const TriangleMesh mesh = shapes::MakeMesh(sphere);
  SparseMatrix matrix =
    cartan::Laplacian(mesh, Eigen::VectorXd::Ones(mesh.NumberOfDirectedEdges()));
  matrix.diagonal().array() += 0.1;
  const SparseMatrix lower = matrix.triangularView<Eigen::Lower>();
  // However far it gets before memory ends, at each step of both stages.
  int failuresOfAnalyze = 0;
  int failuresOfFactorize = 0;
  for (int count = 0; failuresOfAnalyze == count; ++count)
  {
    const auto factor = cartan::MakeSymmetricSolver(cartan::SolverBackend::Cholmod);
    SolverStatus status = SolverStatus::Ok;
    {
      const LimitedAllocations limited(count);
      status = factor->Analyze(lower);
    }
    ASSERT_TRUE(status == SolverStatus::Ok || status == SolverStatus::OutOfMemory) << count;
    failuresOfAnalyze += status == SolverStatus::OutOfMemory ? 1 : 0;
    ASSERT_EQ(factor->Analyze(lower), SolverStatus::Ok) << count; // works again
  }
  EXPECT_GT(failuresOfAnalyze, 3);
  for (int count = 0; failuresOfFactorize == count; ++count)
  {
    const auto factor = cartan::MakeSymmetricSolver(cartan::SolverBackend::Cholmod);
    ASSERT_EQ(factor->Analyze(lower), SolverStatus::Ok);
    SolverStatus status = SolverStatus::Ok;
    {
      const LimitedAllocations limited(count);
      status = factor->Factorize(lower);
    }
    ASSERT_TRUE(status == SolverStatus::Ok || status == SolverStatus::OutOfMemory) << count;
    failuresOfFactorize += status == SolverStatus::OutOfMemory ? 1 : 0;
    ASSERT_EQ(factor->Factorize(lower), SolverStatus::Ok) << count;
    const Eigen::MatrixXd right = Eigen::MatrixXd::Random(lower.rows(), 2);
    ASSERT_EQ(factor->Solve(right), SolverStatus::Ok);
    EXPECT_LT((matrix * factor->GetSolution() - right).norm(), 1e-12);
  }
  EXPECT_GT(failuresOfFactorize, 3);
}
#endif

TEST(SimilarityDeformer, StaysWhereItIs)
{
  // The form of the edges reads the transforms of its owner, which must not move away.
  EXPECT_FALSE(std::is_move_constructible_v<cartan::SimilarityDeformer>);
  EXPECT_FALSE(std::is_copy_constructible_v<cartan::SimilarityDeformer>);
  EXPECT_FALSE(std::is_move_assignable_v<cartan::SimilarityDeformer>);
}
