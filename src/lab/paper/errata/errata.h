#pragma once
// Dou et al. 2014's equations as misprinted, and a constant bias in their units, as user biases (shadow/user_bias.h)
// that are embedded from src/lab/paper/errata/.

namespace gnomon {

extern const char* const kErrataConstantInDepthGlsl;
extern const char* const kErrataEquation6Glsl;
extern const char* const kErrataRayAlongAxisGlsl;
extern const char* const kErrataRayOfLongNormalGlsl;
extern const char* const kErrataRayNotUnitGlsl;

}  // namespace gnomon
