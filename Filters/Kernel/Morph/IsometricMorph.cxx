// SPDX-License-Identifier: BSD-3-Clause
#include "Morph/IsometricMorph.h"

#include "Differential/Laplacian.h"
#include "Mesh/TriangleShape.h"
#include "Morph/LengthErrors.h"
#include "Morph/LengthPolish.h"

#include <cmath>

namespace cartan
{
namespace
{
/// Weights of equal hinges differ by rounding, which would make the tree depend
/// on where the key frames are. In radians and parts of the longest edge.
constexpr double WeightStep = 1e-7;

IdSample WithoutLength(const HingeTopology& topology, const Eigen::VectorXd& lengths)
{
  IdSample sample;
  for (int e = 0; e < topology.NumberOfEdges(); ++e)
  {
    if (!(lengths[e] > 0.0))
    {
      sample.Add(topology.Edges(e, 0));
    }
  }
  return sample;
}

/// Throws if edge lengths or hinge angles are undefined. Fills `lengths`.
void CheckKey(const HingeTopology& topology, const Points& key, int number,
  Eigen::VectorXd& lengths, const ExecutionContext& context)
{
  const std::string name = "Key frame " + std::to_string(number) + " has ";
  if (key.rows() != topology.NumberOfVertices)
  {
    throw Error(ErrorCode::BadInput,
      name + std::to_string(key.rows()) + " points, the surface " +
        std::to_string(topology.NumberOfVertices) +
        ": all key frames must be of the same connectivity.");
  }
  IdSample nonFinite;
  for (Eigen::Index v = 0; v < key.rows(); ++v)
  {
    if (!key.row(v).allFinite())
    {
      nonFinite.Add(v);
    }
  }
  if (!nonFinite.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      name + nonFinite.Describe("point", "points") +
        " with a NaN or infinite coordinate: repair or remove them.");
  }
  lengths = EdgeLengths(topology, key, context);
  const IdSample noLength = WithoutLength(topology, lengths);
  if (!noLength.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      name + noLength.Describe("edge", "edges") +
        " of no length, ids of the first end points: move their end points apart, or merge them in "
        "all key frames.");
  }
}

/// Half of the cotangent of the angle at a corner of a layout. Less flat triangles
/// count as equilateral than elsewhere: weights only say whom to trust, and much
/// larger ones than the others cost the system its digits.
double HalfCotangent(const Layouts& layouts, int t, int corner)
{
  const Eigen::Vector2d a = LayoutEdge(layouts, t, corner);
  const Eigen::Vector2d b = -LayoutEdge(layouts, t, (corner + 2) % 3);
  const double twiceArea = a[0] * b[1] - a[1] * b[0];
  const double longest = std::max({ a.squaredNorm(), b.squaredNorm(), (a - b).squaredNorm() });
  return 0.5 * Cotangent(a.dot(b), twiceArea, longest, 1e-6);
}
}

std::unique_ptr<RotationAveraging> HingeAveraging(
  const HingeTopology& topology, const std::vector<char>& isHeld, const ExecutionContext& context)
{
  const int numberOfHinges = topology.NumberOfHinges();
  Eigen::Matrix<int, Eigen::Dynamic, 2, Eigen::RowMajor> arcs(numberOfHinges, 2);
  std::vector<RotationAveraging::Edge> edges;
  for (int h = 0; h < numberOfHinges; ++h)
  {
    const Hinge& hinge = topology.Hinges[h];
    arcs.row(h) << hinge.Left, hinge.Right;
    edges.push_back({ hinge.Left, hinge.Right });
  }
  auto laplacian = std::make_shared<AnchoredSystem>();
  laplacian->Factorize(
    GraphLaplacian(topology.NumberOfTriangles(), arcs, Eigen::VectorXd::Ones(numberOfHinges)),
    Anchors::Hard(isHeld), context);
  return std::make_unique<RotationAveraging>(
    topology.NumberOfTriangles(), std::move(edges), std::move(laplacian));
}

IsometricMorph::IsometricMorph(
  const KeyFrames& keys, const IsometricMorphOptions& options, const ExecutionContext& context)
  : Topology(*keys.Mesh)
  , Options(options)
{
  if (options.LengthPolish < 0)
  {
    throw Error(ErrorCode::BadInput,
      "The number of rounds on edge lengths is " + std::to_string(options.LengthPolish) +
        "; it must not be negative.");
  }
  this->Interpolate(keys.Positions, keys.Parameters, context.Part(0.0, 0.4));

  // The hinges that turn least come first, of equal ones the shortest, across
  // which neighbors are pulled apart the least.
  const Field& angles = this->KeyAngles.GetValues();
  const Field& lengths = this->KeyLengths.GetValues();
  const Eigen::Index last = angles.cols() - 1;
  const Eigen::VectorXd turns =
    (angles.rightCols(last) - angles.leftCols(last)).cwiseAbs().rowwise().sum();
  const Eigen::VectorXd means = lengths.rowwise().mean();
  const double longest = means.size() ? means.maxCoeff() : 1.0;
  Eigen::VectorXd weights(this->Topology.NumberOfHinges());
  for (int h = 0; h < this->Topology.NumberOfHinges(); ++h)
  {
    // The length counts less than one step of the turn.
    weights[h] = std::round(turns[h] / WeightStep) +
      0.5 * WeightStep * std::round(means[this->Topology.Hinges[h].Edge] / longest / WeightStep);
  }
  this->Forest = DualForest(this->Topology, weights);

  if (options.Type != IsometricMorphOptions::Method::TreeAverage)
  {
    for (const char isWhole : this->Forest.IsWhole)
    {
      this->StitchedComponents += isWhole ? 0 : 1;
    }
  }
  context.Report(0.5);
  if (this->StitchedComponents > 0)
  {
    this->SetUpStitching(context.Part(0.5, 1.0));
  }
}

void IsometricMorph::Interpolate(
  const std::vector<Points>& keys, std::vector<double> parameters, const ExecutionContext& context)
{
  const int count = static_cast<int>(keys.size());
  Field lengths(this->Topology.NumberOfEdges(), count);
  Field angles(this->Topology.NumberOfHinges(), count);
  std::vector<char> isDegenerate(this->Topology.NumberOfTriangles(), 0);
  for (int k = 0; k < count; ++k)
  {
    Eigen::VectorXd ofKey;
    CheckKey(this->Topology, keys[k], k, ofKey, context);
    lengths.col(k) = ofKey;
    const Points normals = HingeNormals(this->Topology, keys[k], &isDegenerate);
    ofKey = HingeAngles(this->Topology, keys[k], normals, context);
    angles.col(k) =
      k == 0 ? ofKey : UnwrappedAngles(this->Topology, keys[k - 1], angles.col(k - 1), ofKey);
    context.Report((k + 1.0) / count);
  }
  for (int t = 0; t < this->Topology.NumberOfTriangles(); ++t)
  {
    if (isDegenerate[t])
    {
      this->Degenerate.Add(t);
    }
  }
  this->KeyLengths = KeyInterpolation(parameters, std::move(lengths));
  this->KeyAngles = KeyInterpolation(std::move(parameters), std::move(angles));
}

void IsometricMorph::SetUpStitching(const ExecutionContext& context)
{
  const int numberOfTriangles = this->Topology.NumberOfTriangles();
  const auto isStitched = [this](int t) { return !this->Forest.IsWhole[this->Forest.Tree[t]]; };

  // Where a tree begins its first frame and vertex are held.
  std::vector<char> isHeldTriangle(numberOfTriangles);
  this->IsHeld.assign(this->Topology.NumberOfVertices, 1);
  for (int t = 0; t < numberOfTriangles; ++t)
  {
    isHeldTriangle[t] = !isStitched(t);
    for (int corner = 0; corner < 3 && isStitched(t); ++corner)
    {
      this->IsHeld[this->Topology.Corners(t, corner)] = 0;
    }
  }
  this->IsUnstitched = this->IsHeld;
  for (const DualForest::Step& step : this->Forest.Steps)
  {
    if (step.Parent < 0)
    {
      isHeldTriangle[step.Triangle] = 1;
      this->IsHeld[this->Topology.Corners(step.Triangle, 0)] = 1;
    }
  }
  if (this->Options.Type == IsometricMorphOptions::Method::Automatic)
  {
    this->Averaging = HingeAveraging(this->Topology, isHeldTriangle, context.Part(0.0, 0.5));
    for (const double t : this->KeyLengths.GetParameters())
    {
      const Layouts layouts = LayOut(this->Topology, this->KeyLengths.Evaluate(t), context);
      this->Known.AddKey(t,
        WalkFrames(this->Topology, this->Forest,
          HingeTransitions(this->Topology, layouts, this->KeyAngles.Evaluate(t), context)));
    }
  }

  const Layouts layouts =
    LayOut(this->Topology, this->KeyLengths.GetValues().rowwise().mean(), context);
  Points cornerWeights(numberOfTriangles, 3);
  for (int t = 0; t < numberOfTriangles; ++t)
  {
    for (int corner = 0; corner < 3; ++corner)
    {
      cornerWeights(t, corner) = HalfCotangent(layouts, t, corner);
    }
  }
  this->Stitching = TriangleStitching(
    this->Topology.Corners, std::move(cornerWeights), this->IsHeld, context.Part(0.5, 1.0));
}

std::size_t IsometricMorph::GetBytes() const
{
  return this->Topology.GetBytes() + this->KeyLengths.GetBytes() + this->KeyAngles.GetBytes() +
    this->Forest.GetBytes() + this->Stitching.GetBytes() +
    (this->Averaging ? this->Averaging->GetBytes() : 0) + this->Known.GetBytes() +
    TotalBytes(this->IsHeld, this->IsUnstitched);
}

Points IsometricMorph::Evaluate(const MorphPlace& place, const ExecutionContext& context)
{
  context.Report(0.0);
  const double t = place.GetParameter();
  const auto endsOf = [this](int e) {
    return std::array{ this->Topology.Edges(e, 0), this->Topology.Edges(e, 1) };
  };
  const auto endsOfHinge = [&](int h) { return endsOf(this->Topology.Hinges[h].Edge); };
  const Eigen::VectorXd lengths =
    place.Sample(this->KeyLengths, this->Topology.NumberOfEdges(), endsOf, context);
  const IdSample noLength = WithoutLength(this->Topology, lengths);
  if (!noLength.IsEmpty())
  {
    throw Error(ErrorCode::BadInput,
      "At the parameter " + std::to_string(t) + " the length of " +
        noLength.Describe("edge", "edges") +
        ", ids of the first end points, would not be positive: stay closer to the key frames.");
  }
  const Layouts layouts = LayOut(this->Topology, lengths, context);
  const Matrices transitions = HingeTransitions(this->Topology, layouts,
    place.Sample(this->KeyAngles, this->Topology.NumberOfHinges(), endsOfHinge, context), context);
  Matrices frames = WalkFrames(this->Topology, this->Forest, transitions);
  this->FrameSteps = 0;
  this->Warning.clear();
  if (this->Averaging)
  {
    this->Average(t, transitions, frames, context.Part(0.1, 0.6));
  }

  Points points = Points::Zero(this->Topology.NumberOfVertices, 3);
  this->Place(layouts, frames, points);
  if (this->StitchedComponents > 0)
  {
    this->Stitch(layouts, frames, points);
    // Nothing else is held: where the tree begins depends on the order of triangles.
    PolishLengths(this->Topology.Edges, lengths, this->IsUnstitched, this->Options.LengthPolish,
      points, context.Part(0.7, 1.0));
  }
  const std::string errors = DescribeLengthErrors(t, this->Topology.Edges, lengths, points);
  if (!errors.empty())
  {
    this->Warning += (this->Warning.empty() ? "" : " ") + errors + " Add a key frame in between.";
  }
  return points;
}

void IsometricMorph::Average(
  double t, const Matrices& transitions, Matrices& frames, const ExecutionContext& context)
{
  // A walk adds up the errors of all hinges on its way. Frames of another
  // parameter are off by less, the more so on twists of several full turns.
  const FrameMemory::Known start = this->Known.Nearest(t);
  for (int triangle = 0; triangle < this->Topology.NumberOfTriangles(); ++triangle)
  {
    if (!this->Forest.IsWhole[this->Forest.Tree[triangle]])
    {
      frames.row(triangle) = start.Frames.row(triangle);
    }
  }
  const RotationAveraging::Result result = this->Averaging->Improve(transitions, frames, context);
  this->FrameSteps = result.Steps;
  // What nobody sees is not worth a warning.
  if (!(result.LastTurn < 1e-3))
  {
    this->Warning = "The frames at the parameter " + std::to_string(t) +
      " are not the best: their improvement did not end. The surface passes through itself, or "
      "the key frames are far from each other; add one in between.";
  }
}

void IsometricMorph::Place(const Layouts& layouts, const Matrices& frames, Points& points) const
{
  // Triangles share the corners of the hinge that they are walked through.
  Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor> corners(
    this->Topology.NumberOfTriangles(), 9);
  const auto corner = [&corners](int t, int c) { return corners.block<1, 3>(t, 3 * (c % 3)); };
  const auto edge = [&](int t, int c) -> Eigen::RowVector3d
  { return (MatrixAt(frames, t).leftCols<2>() * LayoutEdge(layouts, t, c % 3)).transpose(); };
  for (const DualForest::Step& step : this->Forest.Steps)
  {
    const int t = step.Triangle;
    int first = 0;
    if (step.Parent < 0)
    {
      corner(t, 0).setZero();
      corner(t, 1) = edge(t, 0);
    }
    else
    {
      const Hinge& hinge = this->Topology.Hinges[step.Hinge];
      const bool isLeft = hinge.Left == t;
      const int parentCorner = isLeft ? hinge.RightCorner : hinge.LeftCorner;
      first = isLeft ? hinge.LeftCorner : hinge.RightCorner;
      corner(t, first) = corner(step.Parent, parentCorner + 1);
      corner(t, first + 1) = corner(step.Parent, parentCorner);
    }
    corner(t, first + 2) = corner(t, first) - edge(t, first + 2);
  }

  // The mean of all copies of a vertex, as a correction to one of them: exact
  // where all are the same.
  Points sums = Points::Zero(this->Topology.NumberOfVertices, 3);
  Eigen::VectorXi copies = Eigen::VectorXi::Zero(this->Topology.NumberOfVertices);
  for (int t = 0; t < this->Topology.NumberOfTriangles(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const int v = this->Topology.Corners(t, c);
      if (copies[v]++ == 0)
      {
        points.row(v) = corner(t, c);
      }
      sums.row(v) += corner(t, c) - points.row(v);
    }
  }
  for (int v = 0; v < this->Topology.NumberOfVertices; ++v)
  {
    points.row(v) += sums.row(v) / std::max(copies[v], 1);
  }
}

void IsometricMorph::Stitch(const Layouts& layouts, const Matrices& frames, Points& points) const
{
  Matrices corners(this->Topology.NumberOfTriangles(), 9);
  for (int t = 0; t < this->Topology.NumberOfTriangles(); ++t)
  {
    const auto axes = MatrixAt(frames, t).leftCols<2>();
    auto triangle = MatrixAt(corners, t);
    triangle.col(0).setZero();
    triangle.col(1) = axes * LayoutEdge(layouts, t, 0);
    triangle.col(2) = -axes * LayoutEdge(layouts, t, 2);
  }
  this->Stitching.Stitch(corners, points);
}
}
