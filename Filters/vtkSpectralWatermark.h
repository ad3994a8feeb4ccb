// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSpectralWatermark
 * @brief hides a message in the low frequencies of a surface, and reads it
 *
 * EMBED moves the points a little and smoothly, which is hardly visible, so that they carry
 * a message of bits or text. EXTRACT reads the message from a copy that has been moved,
 * scaled, rounded, made noisy or reordered since. It needs the original surface, the key and
 * the settings of the embedding.
 *
 * Input 0: the surface to mark, or the suspect one. Input 1: the original, for EXTRACT only.
 *
 * Output 0: EMBED: the marked surface, with the point array `Patch` (int, -1 at points in no
 * triangle) and the field data `WatermarkRMS`. EXTRACT: the suspect where the original is,
 * with the field data `BitErrors` (with a Message), `WeakestConfidence` and
 * `ChanceProbability`.
 *
 * Output 1: a vtkTable with a row per bit: `Bit` (int, 0 or 1: embedded or read) and, for
 * EXTRACT, `Score` (double: how much the places of the bit agree; without a watermark about a
 * normal distribution of variance 1), `Confidence` (double in [.5, 1]: the probability that
 * the bit is right) and, with a Message, `Expected` (int).
 *
 * Bits add or subtract Strength times the bounding box's diagonal to the coefficients of the
 * positions in the modes of lowest frequency of patches of the surface. The key decides which
 * coefficients carry which bit, and with which sign. The key is no encryption: it keeps
 * others from reading or forging the message by accident, not by effort.
 *
 * The modes are kept: other messages, keys and suspects compute none.
 *
 * Errors, each with empty outputs: no message to embed; more bits than the surface has
 * places; characters other than 0 and 1 in a message of bits; no original to extract with;
 * more modes than fit into ModeMemoryLimit; PatchSize > 0 when Cartan was built without
 * METIS; PrepareInput; see vtkSurfaceFilter.
 *
 * Reference: Ohbuchi, Mukaiyama, Takahashi, A Frequency-Domain Approach to Watermarking 3D
 * Shapes, Computer Graphics Forum 21(3), 2002; Sorkine, Differential Representations for
 * Mesh Processing, Computer Graphics Forum 25(4), 2006, section 3.3.
 *
 * @sa vtkLaplacianSpectrum
 */
#ifndef vtkSpectralWatermark_h
#define vtkSpectralWatermark_h

#include "vtkSetNumberMacro.h" // For properties
#include "vtkSurfaceFilter.h"

#include <string> // For message and key
#include <vector> // For bits

namespace cartan
{
class SpectralWatermark;
struct Surface;
}
class vtkTable;

class VTKCARTAN_EXPORT vtkSpectralWatermark : public vtkSurfaceFilter
{
public:
  static vtkSpectralWatermark* New();
  vtkTypeMacro(vtkSpectralWatermark, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkSpectralWatermark(const vtkSpectralWatermark&) = delete;
  void operator=(const vtkSpectralWatermark&) = delete;

  ///@{
  /**
   * The original surface, input port 1, for EXTRACT.
   */
  void SetOriginalConnection(vtkAlgorithmOutput* original);
  void SetOriginalData(vtkPolyData* original);
  ///@}

  enum ModeType
  {
    EMBED = 0,
    EXTRACT = 1
  };

  ///@{
  /**
   * Whether to hide a message or to read it. Default: EMBED.
   */
  vtkSetClampMacro(Mode, int, EMBED, EXTRACT);
  vtkGetMacro(Mode, int);
  void SetModeToEmbed() { this->SetMode(EMBED); }
  void SetModeToExtract() { this->SetMode(EXTRACT); }
  ///@}

  ///@{
  /**
   * The message to embed; for EXTRACT, the one that is expected, to count errors, or empty.
   * Default: empty.
   */
  void SetMessage(const std::string& message) { this->SetMember(this->Message, message); }
  std::string GetMessage() const { return this->Message; }
  ///@}

  enum MessageFormatType
  {
    TEXT = 0,
    BITS = 1
  };

  ///@{
  /**
   * TEXT: each byte of the message is eight bits, the highest first. BITS: the message is
   * written in 0 and 1. Default: TEXT.
   */
  vtkSetClampMacro(MessageFormat, int, TEXT, BITS);
  vtkGetMacro(MessageFormat, int);
  void SetMessageFormatToText() { this->SetMessageFormat(TEXT); }
  void SetMessageFormatToBits() { this->SetMessageFormat(BITS); }
  ///@}

  ///@{
  /**
   * How many bits EXTRACT reads where Message is empty: as many as were embedded, >= 1.
   * Default: 64.
   */
  vtkSetClampMacro(NumberOfBits, int, 1, VTK_INT_MAX);
  vtkGetMacro(NumberOfBits, int);
  ///@}

  ///@{
  /**
   * What decides where the bits are. EXTRACT needs the key of the embedding. Default: empty.
   */
  void SetKey(const std::string& key) { this->SetMember(this->Key, key); }
  std::string GetKey() const { return this->Key; }
  ///@}

  ///@{
  /**
   * The change of each coefficient, in parts of the bounding box's diagonal, > 0. The root
   * mean square change of the points is at most Strength sqrt(3 ModeFraction) diagonals.
   * Default: .001.
   */
  vtkSetNumberMacro(Strength, 1e-12, 1.0);
  vtkGetMacro(Strength, double);
  ///@}

  ///@{
  /**
   * About how many points a patch has, >= 0; 0: the whole surface is one. Larger patches
   * have lower frequencies and take longer. EXTRACT needs that of the embedding. Default:
   * 1000.
   */
  vtkSetClampMacro(PatchSize, int, 0, VTK_INT_MAX);
  vtkGetMacro(PatchSize, int);
  ///@}

  ///@{
  /**
   * How many modes carry the message, in parts of the points, in [0, 1]. EXTRACT needs that
   * of the embedding. Default: .07.
   */
  vtkSetNumberMacro(ModeFraction, 0.0, 1.0);
  vtkGetMacro(ModeFraction, double);
  ///@}

  ///@{
  /**
   * Whether EXTRACT moves and scales the suspect onto the original. Default: on.
   */
  vtkSetMacro(Align, bool);
  vtkGetMacro(Align, bool);
  vtkBooleanMacro(Align, bool);
  ///@}

  ///@{
  /**
   * How much memory the computation of a patch's modes may take, without the factorization,
   * in megabytes (10^6 bytes), >= 1. Default: 4000.
   */
  vtkSetClampMacro(ModeMemoryLimit, int, 1, VTK_INT_MAX);
  vtkGetMacro(ModeMemoryLimit, int);
  ///@}

  /**
   * Output 1, valid after Update().
   */
  vtkTable* GetBitTable();

  ///@{
  /**
   * Results of the last update. The message as it was read, in MessageFormat (bytes of a text
   * that are no printable characters of ASCII are '?'); how many bits differ from Message, -1
   * without one; the least confidence of a bit; the probability that a surface without
   * this watermark agrees as much with Message, or, without one, a bound of the probability
   * that it gives such scores; the root mean square change of the points by EMBED, in length
   * units.
   */
  std::string GetExtractedMessage() const { return this->ExtractedMessage; }
  vtkGetMacro(BitErrors, int);
  vtkGetMacro(WeakestConfidence, double);
  vtkGetMacro(ChanceProbability, double);
  vtkGetMacro(WatermarkRMS, double);
  ///@}

protected:
  vtkSpectralWatermark();
  ~vtkSpectralWatermark() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  void UsePreparedInput(cartan::FilterRun& run) const override;
  void Execute(cartan::FilterRun& run) override;
  void ForgetResults() override;

private:
  std::vector<char> MessageBits() const;
  std::shared_ptr<const cartan::SpectralWatermark> MakeWatermark(
    cartan::FilterRun& run, const cartan::Surface& surface);
  void Embed(cartan::FilterRun& run);
  void Extract(cartan::FilterRun& run);

  std::string Message;
  std::string Key;
  std::string ExtractedMessage;
  int Mode = EMBED;
  int MessageFormat = TEXT;
  int NumberOfBits = 64;
  int PatchSize = 1000;
  int ModeMemoryLimit = 4000;
  int BitErrors = -1;
  double Strength = 0.001;
  double ModeFraction = 0.07;
  double WeakestConfidence = 0.0;
  double ChanceProbability = 1.0;
  double WatermarkRMS = 0.0;
  bool Align = true;
};

#endif
