// The tone operators of vesper/operators.h, and their settings. SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include <vesper/operators.h>
#include <render/operators/all.inc>

namespace vesper::render {

/// How scene luminance becomes display luminance.
enum class Operator : uint8_t {
#define VESPER_ENUMERATOR(NAME, Name, name, value, summary) Name = (value),
    VESPER_OPERATORS(VESPER_ENUMERATOR)
#undef VESPER_ENUMERATOR
};

struct OperatorInfo : OperatorTraits {
    Operator tone_operator;
    std::string_view name;     ///< as users write it
    std::string_view summary;  ///< author, year, in a line
};

/// Every operator, in the order of the enumeration.
std::span<const OperatorInfo> operators();
const OperatorInfo& operator_info(Operator);

/// Luminance of the display, cd/m^2, for a grey pixel of `luminance`, cd/m^2, with the curve that the operator made of
/// a frame. Of operators that map contrast in bands: where there is none.
double shown_luminance(Operator, const shared::ToneCurve&, double luminance, const vision::Display&);

/// The settings of every operator.
struct OperatorSettings {
#define VESPER_SETTINGS(NAME, Name, name, value, summary) Name##Settings name;
    VESPER_OPERATORS(VESPER_SETTINGS)
#undef VESPER_SETTINGS

    /// Calls visit(&OperatorSettings::name) for each operator.
    template <class Visit>
    static void each(const Visit& visit) {
#define VESPER_VISIT(NAME, Name, name, value, summary) visit(&OperatorSettings::name);
        VESPER_OPERATORS(VESPER_VISIT)
#undef VESPER_VISIT
    }

    /// Of one operator, as its shader reads them.
    OperatorBlock block(Operator, const vision::Display&) const;
    /// Whether its picture depends on the bins of the histogram.
    bool uses_histogram(Operator) const;
    /// Throws Error where settings contradict each other.
    void check() const;
};

}  // namespace vesper::render
