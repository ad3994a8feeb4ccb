// SPDX-License-Identifier: BSD-3-Clause
// A file may come from anyone: whatever it holds, there is one error and no harm.
#include "CompressedFiles.h"

#include "Kernel/Compression/RangeCoder.h"

#include <gtest/gtest.h>

#include <random>

using compressed::Bytes;
using compressed::ProblemOf;

namespace
{
/// Two components, two steps, an array, and a free point.
Bytes GoodFile()
{
  shapes::Shape shape = shapes::Union(shapes::Icosphere(1), shapes::Plane(2));
  shape.Positions.conservativeResize(shape.Positions.rows() + 1, 3);
  shape.Positions.bottomRows(1).setConstant(9.0);
  cartan::CompressedSurface surface =
    compressed::SurfaceOf(shape, { shape.Positions, cartan::Points(1.1 * shape.Positions) }, 6, 4);
  cartan::CodedArray array;
  array.Name = "Rank";
  array.Type = cartan::ScalarType::UInt16;
  array.Bytes.resize(2 * static_cast<std::size_t>(shape.NumberOfVertices()), 3);
  surface.Steps[0].Arrays = { array };
  return cartan::Compress(surface);
}

/// What a change of a section with right checksums gives.
std::string ProblemWith(std::size_t section, std::size_t at, int count, std::uint64_t value)
{
  Bytes file = GoodFile();
  compressed::SetNumber(file, compressed::SectionAt(file, section) + at, count, value);
  compressed::Reseal(file);
  return ProblemOf(file);
}

constexpr std::size_t Counts = 0; // the section with the counts, and where it has them
constexpr std::size_t VerticesAt = 0;
constexpr std::size_t UsedAt = 8;
constexpr std::size_t TrianglesAt = 16;
constexpr std::size_t BitsAt = 25;
constexpr std::size_t AnchorsAt = 26;
constexpr std::size_t StepsAt = 30;
}

TEST(BadFiles, TheGoodOneIsGood)
{
  Bytes file = GoodFile();
  EXPECT_EQ(ProblemOf(file), "");
  const Bytes before = file;
  compressed::Reseal(file);
  EXPECT_EQ(file, before);
}

TEST(BadFiles, CutAnywhere)
{
  const Bytes file = GoodFile();
  for (std::size_t size = 0; size < file.size(); ++size)
  {
    EXPECT_NE(ProblemOf(Bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size))), "")
      << size;
  }
  Bytes longer = file;
  longer.push_back(0);
  EXPECT_NE(ProblemOf(longer), "");
}

TEST(BadFiles, EachBitFlipped)
{
  Bytes file = GoodFile();
  for (std::size_t bit = 0; bit < 8 * file.size(); ++bit)
  {
    const auto mask = static_cast<unsigned char>(1 << bit % 8);
    file[bit / 8] ^= mask;
    EXPECT_NE(ProblemOf(file), "") << bit;
    file[bit / 8] ^= mask;
  }
}

TEST(BadFiles, EachBitFlippedUnderRightChecksums)
{
  const Bytes good = GoodFile();
  for (std::size_t bit = 8 * compressed::TableAt; bit < 8 * good.size(); ++bit)
  {
    Bytes file = good;
    file[bit / 8] ^= static_cast<unsigned char>(1 << bit % 8);
    compressed::Reseal(file);
    ProblemOf(file); // another surface, or an error
  }
}

TEST(BadFiles, RandomBlocks)
{
  const Bytes good = GoodFile();
  std::mt19937 random(17);
  int errors = 0;
  for (int round = 0; round < 2000; ++round)
  {
    Bytes file = good;
    const std::size_t length = 1 + random() % 40;
    const std::size_t begin =
      compressed::TableAt + random() % (file.size() - compressed::TableAt - length);
    for (std::size_t i = begin; i < begin + length; ++i)
    {
      file[i] = static_cast<unsigned char>(random());
    }
    EXPECT_NE(ProblemOf(file), "");
    compressed::Reseal(file);
    errors += ProblemOf(file).empty() ? 0 : 1;
  }
  EXPECT_GT(errors, 1000);
}

TEST(BadFiles, DeclaredSizesBeyondReason)
{
  for (const std::uint64_t size : { std::uint64_t{ 1 } << 63, ~std::uint64_t{ 0 },
         std::uint64_t{ 1 } << 32, std::uint64_t{ 1 } << 31, std::uint64_t{ 1 } << 28 })
  {
    EXPECT_NE(ProblemWith(Counts, VerticesAt, 8, size).find("vertices"), std::string::npos);
    EXPECT_NE(ProblemWith(Counts, UsedAt, 8, size).find("vertices"), std::string::npos);
    EXPECT_NE(ProblemWith(Counts, TrianglesAt, 8, size).find("triangles"), std::string::npos);
    Bytes file = GoodFile();
    for (std::size_t section = 0; section < 5; ++section)
    {
      Bytes changed = file;
      compressed::SetNumber(
        changed, compressed::TableAt + 16 * section + compressed::LengthAt, 8, size);
      EXPECT_NE(ProblemOf(changed).find("cut off"), std::string::npos);
    }
  }
  EXPECT_NE(ProblemWith(Counts, AnchorsAt, 4, 0xffffffff).find("anchors"), std::string::npos);
  EXPECT_NE(ProblemWith(Counts, StepsAt, 4, 0xffffffff).find("time steps"), std::string::npos);
  EXPECT_NE(ProblemWith(Counts, StepsAt, 4, 0).find("time steps"), std::string::npos);
  EXPECT_NE(ProblemWith(Counts, BitsAt, 1, 17).find("bits"), std::string::npos);
  Bytes file = GoodFile();
  compressed::SetNumber(file, compressed::CountAt, 4, 0xffffffff);
  EXPECT_NE(ProblemOf(file).find("header"), std::string::npos);
}

TEST(BadFiles, ConnectivityThatIsNoManifold)
{
  // Decisions at the first gate of a second triangle. Before any is learned they are bits: no
  // border, no new vertex, the side of the front, then a step further as long as there are ones.
  struct Case
  {
    std::vector<int> Decisions;
    const char* Problem;
  };
  std::vector<int> farAway(3 + 16, 1); // then the number of an edge that was never made: 0 back
  farAway[0] = farAway[1] = 0;
  farAway.push_back(0);
  const Bytes good = GoodFile();
  for (const Case& bad : { Case{ { 0, 0, 0, 1, 0 }, "manifold" }, // two corners are one vertex
         Case{ { 0, 0, 1, 1, 0 }, "cannot be decoded" },          // the gate itself
         Case{ farAway, "cannot be decoded" } })
  {
    cartan::RangeEncoder coder;
    for (const int decision : bad.Decisions)
    {
      coder.CodeRaw(static_cast<std::uint32_t>(decision), 1);
    }
    std::vector<cartan::sectionfile::Section> sections;
    for (const auto& view : cartan::sectionfile::Read(good.data(), good.size()))
    {
      sections.push_back({ view.Tag, { view.Bytes, view.Bytes + view.Size } });
    }
    sections[1].Bytes = coder.Finish();
    compressed::SetNumber(sections[0].Bytes, VerticesAt, 8, 3);
    compressed::SetNumber(sections[0].Bytes, UsedAt, 8, 3);
    compressed::SetNumber(sections[0].Bytes, TrianglesAt, 8, 2);
    compressed::SetNumber(sections[0].Bytes, AnchorsAt, 4, 1);
    const std::string problem = ProblemOf(cartan::sectionfile::Write(sections));
    EXPECT_TRUE(problem.find(bad.Problem) != std::string::npos) << problem;
  }
}

TEST(BadFiles, OfAnotherKindOrVersion)
{
  const std::string text = "# vtk DataFile Version 3.0 and more of it";
  EXPECT_EQ(ProblemOf(Bytes(text.begin(), text.end())), "it is not a compressed surface");
  Bytes file = GoodFile();
  file[8] = 1;
  EXPECT_NE(ProblemOf(file).find("version 1, and version 2 can be read"), std::string::npos);
}
