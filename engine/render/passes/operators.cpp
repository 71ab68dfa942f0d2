#include "render/passes/operators.h"

#include "shared/tone.h"

namespace vesper {
namespace {

using namespace shared;

constexpr OperatorInfo kOperators[]{
    {Operator::Irawan, "irawan", "Irawan, Ferwerda, Marschner 2005 (reconstructed): histogram adjustment for an eye that adapts over time",
     kToneCurve, kModelHistogram, kCeilingEye, kAdaptGaze, true},
    {Operator::Ward, "ward", "Ward Larson, Rushmeier, Piatko 1997: histogram adjustment for an adapted eye",
     kToneCurve, kModelTrimmed, kCeilingHuman, kAdaptAverage, false},
    {Operator::Reinhard, "reinhard", "Reinhard, Stark, Shirley, Ferwerda 2002, global", kToneReinhard, kModelFixed, kCeilingEye, kAdaptGaze, false},
    {Operator::Linear, "linear", "linear between two luminances", kToneLinear, kModelFixed, kCeilingEye, kAdaptGaze, false},
    {Operator::Ldr, "ldr", "no HDR: lamps of 1.0, sums clamped to 1", kToneLdr, kModelFixed, kCeilingEye, kAdaptGaze, false},
    {Operator::Pattanaik, "pattanaik", "Pattanaik, Tumblin, Yee, Greenberg 2000: responses of an eye that adapts over time", kToneColour, kModelPattanaik, kCeilingEye, kAdaptAverage, true},
    {Operator::Ferwerda, "ferwerda", "Ferwerda, Pattanaik, Shirley, Greenberg 1996: linear gains of cones and rods", kToneRods, kModelGains, kCeilingHuman, kAdaptGaze, false},
    {Operator::Durand, "durand", "Durand, Dorsey 2000 (reconstructed): gains of cones and rods of an eye that adapts over time, also to colour", kToneRods, kModelGains, kCeilingEye, kAdaptGaze, true,
     {1.05f, 0.97f, 1.27f}, true},
    {.tone_operator = Operator::Grave, .name = "grave", .summary = "Grave, Bremond 2008 (reconstructed): bands of contrast, each with the visibility level it has in the scene",
     .form = kToneCurve, .model = kModelHistogram, .ceiling = kCeilingCones, .adapt_to = kAdaptGaze, .remembers = false, .bands = true},
};

}  // namespace

std::span<const OperatorInfo> operators() { return kOperators; }

const OperatorInfo& operator_info(Operator tone_operator) { return kOperators[size_t(tone_operator)]; }

}  // namespace vesper
