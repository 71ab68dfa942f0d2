#include "render/passes/operators.h"

#include <algorithm>
#include <cmath>

namespace vesper::render {
namespace {

constexpr OperatorInfo kOperators[]{
#define VESPER_INFO(NAME, Name, name, value, summary) {Name##Settings::traits, Operator::Name, #name, summary},
    VESPER_OPERATORS(VESPER_INFO)
#undef VESPER_INFO
};

constexpr bool values_are_indices() {
    for (size_t i = 0; i < std::size(kOperators); ++i)
        if (size_t(kOperators[i].tone_operator) != i) return false;
    return true;
}
static_assert(values_are_indices());

/// Pixels are mapped by a form of shared/tone.h or by the operator's own shader.
constexpr bool forms_are_known() {
    for (const OperatorInfo& info : kOperators)
        if (info.form > shared::kToneRods && info.form != uint32_t(info.tone_operator)) return false;
    return true;
}
static_assert(forms_are_known());

/// Calls visit(settings) for one operator.
template <class Visit>
void visit_one(const OperatorSettings& all, Operator wanted, const Visit& visit) {
    switch (wanted) {
#define VESPER_CASE(NAME, Name, name, value, summary) \
    case Operator::Name:                              \
        return visit(all.name);
        VESPER_OPERATORS(VESPER_CASE)
#undef VESPER_CASE
    }
}

}  // namespace

std::span<const OperatorInfo> operators() { return kOperators; }

const OperatorInfo& operator_info(Operator tone_operator) { return kOperators[size_t(tone_operator)]; }

double shown_luminance(Operator wanted, const shared::ToneCurve& curve, double luminance,
                       const vision::Display& display) {
    const double low = display.low(), high = display.high();
    double shown = 0;
    // A form is the number of the first operator that has it.
    visit_one(OperatorSettings{}, Operator(operator_info(wanted).form), [&](const auto& settings) {
        if constexpr (requires { settings.shown(curve, luminance); })
            shown = low + (high - low) * std::clamp(settings.shown(curve, luminance), 0.0, 1.0);
        else
            shown = std::min(high, std::exp(node_at(curve, luminance).x));
    });
    return shown;
}

OperatorBlock OperatorSettings::block(Operator wanted, const vision::Display& display) const {
    OperatorBlock made{};
    visit_one(*this, wanted, [&](const auto& settings) {
        if constexpr (requires { settings.block(display); }) made = settings.block(display);
    });
    return made;
}

bool OperatorSettings::uses_histogram(Operator wanted) const {
    bool uses = operator_info(wanted).histogram;
    visit_one(*this, wanted, [&](const auto& settings) {
        if constexpr (requires { settings.counts_finely(); }) uses |= settings.counts_finely();
    });
    return uses;
}

void OperatorSettings::check() const {
    for (const OperatorInfo& info : operators())
        visit_one(*this, info.tone_operator, [](const auto& settings) {
            if constexpr (requires { settings.check(); }) settings.check();
        });
}

}  // namespace vesper::render
