// SPDX-License-Identifier: BSD-3-Clause
#include "Compression/CompressedSurface.h"

#include "Base/Error.h"
#include "Compression/ConnectivityCoder.h"
#include "Compression/ResidualCoder.h"
#include "Compression/SectionFile.h"

#include <algorithm>
#include <limits>

namespace cartan
{
namespace
{
/// A tag is four letters.
constexpr std::uint32_t TagOf(const char (&letters)[5])
{
  return static_cast<std::uint32_t>(static_cast<unsigned char>(letters[0])) |
    static_cast<std::uint32_t>(static_cast<unsigned char>(letters[1])) << 8 |
    static_cast<std::uint32_t>(static_cast<unsigned char>(letters[2])) << 16 |
    static_cast<std::uint32_t>(static_cast<unsigned char>(letters[3])) << 24;
}

constexpr std::uint32_t SurfaceTag = TagOf("SURF"); // counts, times, anchors
constexpr std::uint32_t ConnectivityTag = TagOf("CONN");
constexpr std::uint32_t PointOrderTag = TagOf("ORDR");
constexpr std::uint32_t StepTag = TagOf("STEP");
constexpr std::uint32_t ArrayTag = TagOf("ARRY"); // of the step before it

/// What the section of counts has before times and anchors.
constexpr std::size_t CountBytes = 34;

constexpr unsigned SinglePrecisionFlag = 1;
constexpr unsigned PointOrderFlag = 2;

[[noreturn]] void Refuse(const std::string& what)
{
  throw Error(ErrorCode::BadInput, what);
}

void Require(bool isRight, const char* what)
{
  if (!isRight)
  {
    Refuse(what);
  }
}

/// Numbers as differences from the one before, each by the length of the difference before.
template <typename Coder>
void CodeNumbers(Coder& coder, std::vector<int>& numbers)
{
  constexpr std::int64_t Largest = std::numeric_limits<int>::max();
  std::vector<LengthModel> models(33);
  std::vector<BitModel> signs(models.size());
  IntegerCoder<Coder> integers(coder);
  std::int64_t before = -1;
  std::size_t length = 0;
  for (int& number : numbers)
  {
    const std::int32_t difference =
      integers.Code(models[length], signs[length], static_cast<std::int32_t>(number - before));
    before += difference;
    Require(before >= 0 && before <= Largest, "a vertex is out of range");
    number = static_cast<int>(before);
    for (length = 0; std::abs(static_cast<std::int64_t>(difference)) >> length != 0; ++length)
    {
    }
  }
}

template <typename Coder>
void CodeAnchorPositions(Coder& coder, HighPassCode& code)
{
  for (Eigen::Index i = 0; i < code.AnchorPositions.size(); ++i)
  {
    std::int32_t& cell = code.AnchorPositions.data()[i];
    cell = static_cast<std::int32_t>(
      coder.CodeRaw(static_cast<std::uint32_t>(cell), HighPassCode::AnchorBits));
  }
}

int NumberOfUsed(const TriangleMesh& mesh)
{
  int used = 0;
  while (used < mesh.NumberOfVertices() && mesh.IsUsed(used))
  {
    ++used;
  }
  return used;
}

/// The differential coordinate that most are near: zero.
std::int32_t CenterOf(const HighPassCode& code)
{
  const double cells = std::ldexp(1.0, code.Bits);
  return code.Range > 0.0
    ? static_cast<std::int32_t>(std::clamp(-code.Low / code.Range * cells, 0.0, cells - 1.0))
    : 0;
}

bool HasScaleOf(const HighPassCode& code, const HighPassCode& other)
{
  return code.Side == other.Side && code.Low == other.Low && code.Range == other.Range;
}

std::vector<unsigned char> EncodeSurface(const CompressedSurface& surface)
{
  const HighPassCode& code = surface.Steps.front().Code;
  ByteWriter writer;
  writer.U64(static_cast<std::uint64_t>(surface.Mesh->NumberOfVertices()));
  writer.U64(static_cast<std::uint64_t>(NumberOfUsed(*surface.Mesh)));
  writer.U64(static_cast<std::uint64_t>(surface.Mesh->NumberOfTriangles()));
  writer.U8(static_cast<std::uint8_t>((surface.IsSinglePrecision ? SinglePrecisionFlag : 0) |
    (surface.OldNumbers.empty() ? 0 : PointOrderFlag)));
  writer.U8(static_cast<std::uint8_t>(code.Bits));
  writer.U32(static_cast<std::uint32_t>(code.Anchors.size()));
  writer.U32(static_cast<std::uint32_t>(surface.Steps.size()));
  for (const CodedStep& step : surface.Steps)
  {
    writer.F64(step.Time);
  }
  RangeEncoder coder;
  std::vector<int> anchors = code.Anchors;
  CodeNumbers(coder, anchors);
  writer.AppendFor(coder.Finish(), anchors.size());
  return writer.Finish();
}

std::vector<unsigned char> EncodeNumbers(std::vector<int> numbers)
{
  RangeEncoder coder;
  CodeNumbers(coder, numbers);
  ByteWriter writer;
  writer.AppendFor(coder.Finish(), numbers.size());
  return writer.Finish();
}

std::vector<unsigned char> EncodeConnectivity(const TriangleMesh& mesh)
{
  ByteWriter writer;
  writer.AppendFor(EncodeTriangles(mesh), static_cast<std::size_t>(mesh.NumberOfTriangles()),
    ByteWriter::MostTrianglesPerByte);
  return writer.Finish();
}

/// As differences from the step before, or from the center where that is null.
std::vector<unsigned char> EncodeStep(
  const TriangleMesh& mesh, const CodedStep& step, const CodedStep* before)
{
  const HighPassCode& code = step.Code;
  ByteWriter writer;
  writer.U8(before ? 1 : 0);
  writer.U32(static_cast<std::uint32_t>(step.Arrays.size()));
  const std::int32_t center = CenterOf(code);
  writer.U32(static_cast<std::uint32_t>(center));
  for (const double number :
    { code.Corner[0], code.Corner[1], code.Corner[2], code.Side, code.Low, code.Range })
  {
    writer.F64(number);
  }
  for (Eigen::Index i = 0; i < step.FreePoints.size(); ++i)
  {
    writer.F64(step.FreePoints.data()[i]);
  }
  RangeEncoder coder;
  HighPassCode copy = code;
  CodeAnchorPositions(coder, copy);
  Residuals residuals =
    before ? Residuals(code.Deltas - before->Code.Deltas) : Residuals(code.Deltas.array() - center);
  CodeResiduals(coder, mesh, residuals);
  writer.AppendFor(coder.Finish(), static_cast<std::size_t>(mesh.NumberOfVertices()));
  return writer.Finish();
}

/// The counts of a file, and where the code of its anchors begins.
struct Head
{
  explicit Head(const sectionfile::SectionView& section)
    : Reader(section)
  {
    Require(section.Tag == SurfaceTag, "it has no counts");
    this->Vertices = this->Reader.U64();
    this->Used = this->Reader.U64();
    this->Triangles = this->Reader.U64();
    this->Flags = this->Reader.U8();
    this->Bits = this->Reader.U8();
    this->Anchors = this->Reader.U32();
    const std::uint32_t steps = this->Reader.U32();
    Require(steps > 0 && steps <= this->Reader.RestSize() / sizeof(double),
      "it has no time steps, or too many");
    for (std::uint32_t i = 0; i < steps; ++i)
    {
      this->Times.push_back(this->Reader.F64());
    }
  }

  /// That no count is more than the bytes can be.
  void Check(std::size_t connectivitySize, std::size_t fileSize) const
  {
    Require(this->Triangles > 0 &&
        this->Triangles <= std::uint64_t{ TriangleMesh::MostTriangles } &&
        this->Triangles / ByteWriter::MostTrianglesPerByte <= connectivitySize,
      "it cannot have as many triangles as it is said to have");
    Require(this->Used <= 3 * this->Triangles && this->Used <= this->Vertices &&
        this->Vertices / ByteWriter::MostElementsPerByte <= fileSize &&
        this->Vertices - this->Used <= fileSize / (3 * sizeof(double)),
      "it cannot have as many vertices as it is said to have");
    Require(this->Bits >= 1 && this->Bits <= 16, "it has an unknown number of bits");
    Require(this->Anchors >= 1 && this->Anchors <= this->Used,
      "it cannot have as many anchors as it is said to have");
  }

  ByteReader Reader;
  std::uint64_t Vertices = 0;
  std::uint64_t Used = 0;
  std::uint64_t Triangles = 0;
  unsigned Flags = 0;
  int Bits = 0;
  std::uint32_t Anchors = 0;
  std::vector<double> Times;
};

std::vector<int> DecodeAnchors(const Head& head, const TriangleMesh& mesh)
{
  head.Reader.RequireRestFor(head.Anchors);
  std::vector<int> anchors(head.Anchors);
  RangeDecoder coder(head.Reader.Rest(), head.Reader.RestSize());
  CodeNumbers(coder, anchors);
  std::vector<char> isAnchored(static_cast<std::size_t>(mesh.NumberOfComponents()), 0);
  for (std::size_t i = 0; i < anchors.size(); ++i)
  {
    Require(
      static_cast<std::uint64_t>(anchors[i]) < head.Used && (i == 0 || anchors[i] > anchors[i - 1]),
      "its anchors are out of order");
    isAnchored[mesh.Component(anchors[i])] = 1;
  }
  Require(std::find(isAnchored.begin(), isAnchored.end(), 0) == isAnchored.end(),
    "a component has no anchor");
  return anchors;
}

std::shared_ptr<const TriangleMesh> DecodeConnectivity(
  const Head& head, const sectionfile::SectionView& section)
{
  Require(section.Tag == ConnectivityTag, "it has no connectivity");
  MeshReport report;
  auto mesh = std::make_shared<TriangleMesh>(TriangleMesh::Build(static_cast<int>(head.Vertices),
    DecodeTriangles(section.Bytes, section.Size, static_cast<int>(head.Triangles),
      static_cast<std::size_t>(head.Used)),
    report));
  Require(report.IsManifold(), "its triangles are not an oriented manifold");
  // Those that are used come first, and no others.
  const int used = NumberOfUsed(*mesh);
  bool isRight = static_cast<std::uint64_t>(used) == head.Used;
  for (int v = used; v < mesh->NumberOfVertices(); ++v)
  {
    isRight = isRight && !mesh->IsUsed(v);
  }
  Require(isRight, "its vertices are out of order");
  return mesh;
}

std::vector<int> DecodePointOrder(const sectionfile::SectionView& section, int numberOfVertices)
{
  Require(section.Tag == PointOrderTag, "it has no order of points");
  ByteReader(section).RequireRestFor(static_cast<std::uint64_t>(numberOfVertices));
  std::vector<int> numbers(static_cast<std::size_t>(numberOfVertices));
  RangeDecoder coder(section.Bytes, section.Size);
  CodeNumbers(coder, numbers);
  std::vector<char> isTaken(numbers.size(), 0);
  for (const int number : numbers)
  {
    Require(number < numberOfVertices && !isTaken[number], "its order of points is none");
    isTaken[number] = 1;
  }
  return numbers;
}

/// A step of which the number of bits and the anchors are set. Returns how many arrays follow.
std::uint32_t DecodeStep(const sectionfile::SectionView& section, const TriangleMesh& mesh,
  const CodedStep* before, CodedStep& step)
{
  Require(section.Tag == StepTag, "a time step is missing");
  HighPassCode& code = step.Code;
  const int vertices = mesh.NumberOfVertices();
  ByteReader reader(section);
  const bool isDifference = reader.U8() != 0;
  const std::uint32_t arrays = reader.U32();
  const std::uint32_t center = reader.U32();
  for (double* number : { code.Corner.data(), code.Corner.data() + 1, code.Corner.data() + 2,
         &code.Side, &code.Low, &code.Range })
  {
    *number = reader.F64();
  }
  Require(code.Side >= 0.0 && code.Range >= 0.0 && center >> code.Bits == 0 &&
      (!isDifference || (before && HasScaleOf(code, before->Code))),
    "the scale of a time step makes no sense");
  step.FreePoints.resize(vertices - NumberOfUsed(mesh), 3);
  for (Eigen::Index i = 0; i < step.FreePoints.size(); ++i)
  {
    step.FreePoints.data()[i] = reader.AnyF64();
  }
  reader.RequireRestFor(static_cast<std::uint64_t>(vertices));
  RangeDecoder coder(reader.Rest(), reader.RestSize());
  code.AnchorPositions.setZero(static_cast<Eigen::Index>(code.Anchors.size()), 3);
  CodeAnchorPositions(coder, code);
  Residuals residuals = Residuals::Zero(vertices, 3);
  CodeResiduals(coder, mesh, residuals);
  code.Deltas = isDifference ? Residuals(residuals + before->Code.Deltas)
                             : Residuals(residuals.array() + static_cast<std::int32_t>(center));
  code.Deltas.bottomRows(step.FreePoints.rows()).setZero();
  Require(code.Deltas.minCoeff() >= 0 && code.Deltas.maxCoeff() >> code.Bits == 0,
    "a differential coordinate is out of range");
  return arrays;
}
}

std::vector<unsigned char> Compress(const CompressedSurface& surface, CompressedSizes* sizes)
{
  const TriangleMesh& mesh = *surface.Mesh;
  std::vector<sectionfile::Section> sections = { { SurfaceTag, EncodeSurface(surface) },
    { ConnectivityTag, EncodeConnectivity(mesh) } };
  if (!surface.OldNumbers.empty())
  {
    sections.push_back({ PointOrderTag, EncodeNumbers(surface.OldNumbers) });
  }
  const CodedStep* before = nullptr;
  for (const CodedStep& step : surface.Steps)
  {
    std::vector<unsigned char> bytes = EncodeStep(mesh, step, nullptr);
    if (before && HasScaleOf(step.Code, before->Code))
    {
      std::vector<unsigned char> difference = EncodeStep(mesh, step, before);
      if (difference.size() < bytes.size())
      {
        bytes.swap(difference);
      }
    }
    sections.push_back({ StepTag, std::move(bytes) });
    for (const CodedArray& array : step.Arrays)
    {
      ByteWriter writer;
      WriteArray(array, writer);
      sections.push_back({ ArrayTag, writer.Finish() });
    }
    before = &step;
  }
  std::vector<unsigned char> file = sectionfile::Write(sections);
  if (sizes)
  {
    *sizes = {};
    sizes->Total = file.size();
    for (const sectionfile::Section& section : sections)
    {
      std::size_t& sum = section.Tag == ConnectivityTag ? sizes->Connectivity
        : section.Tag == PointOrderTag                  ? sizes->PointOrder
        : section.Tag == ArrayTag                       ? sizes->Arrays
                                                        : sizes->Geometry;
      sum += section.Bytes.size();
    }
    sizes->Geometry -= CountBytes + sizeof(double) * surface.Steps.size();
  }
  return file;
}

std::vector<double> ReadTimes(const unsigned char* bytes, std::size_t size)
{
  const std::vector<sectionfile::SectionView> sections = sectionfile::Read(bytes, size);
  Require(!sections.empty(), "it is empty");
  return Head(sections.front()).Times;
}

CompressedSurface Decompress(const unsigned char* bytes, std::size_t size)
{
  const std::vector<sectionfile::SectionView> sections = sectionfile::Read(bytes, size);
  Require(sections.size() >= 3, "it has no surface");
  const Head head(sections[0]);
  head.Check(sections[1].Size, size);
  CompressedSurface surface;
  surface.IsSinglePrecision = (head.Flags & SinglePrecisionFlag) != 0;
  surface.Mesh = DecodeConnectivity(head, sections[1]);
  const std::vector<int> anchors = DecodeAnchors(head, *surface.Mesh);
  std::size_t at = 2;
  const auto next = [&]() -> const sectionfile::SectionView&
  {
    Require(at < sections.size(), "a section is missing");
    return sections[at++];
  };
  if (head.Flags & PointOrderFlag)
  {
    surface.OldNumbers = DecodePointOrder(next(), surface.Mesh->NumberOfVertices());
  }
  for (const double time : head.Times)
  {
    CodedStep step;
    step.Time = time;
    step.Code.Bits = head.Bits;
    step.Code.Anchors = anchors;
    const CodedStep* before = surface.Steps.empty() ? nullptr : &surface.Steps.back();
    std::uint32_t arrays = DecodeStep(next(), *surface.Mesh, before, step);
    for (; arrays > 0; --arrays)
    {
      const sectionfile::SectionView& section = next();
      Require(section.Tag == ArrayTag, "a point array is missing");
      ByteReader reader(section);
      step.Arrays.push_back(ReadArray(reader, surface.Mesh->NumberOfVertices()));
    }
    surface.Steps.push_back(std::move(step));
  }
  Require(at == sections.size(), "it has more sections than it is said to have");
  return surface;
}
}
