// Made by tools/maths_constants.py, which says from what.
#pragma once

#include <cstdint>

namespace takt::maths {

struct Pair {
  double high;
  double low;  // what is left
};

// pi/2.
inline constexpr Pair kHalfPi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
// pi/2 in parts of 43 bits and the rest: their products with 10 bits are exact.
inline constexpr double kHalfPiParts[] = {0x1.921fb54442c00p+0, 0x1.18469898cc400p-44, 0x1.1701b839a2520p-88};
inline constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;  // 2/pi
// The bits of 2/pi: a word before the point, then those behind it.
inline constexpr std::uint64_t kTwoOverPiBits[] = {
    0x0000000000000000, 0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, 0xfe5163abdebbc561,
    0xb7246e3a424dd2e0, 0x06492eea09d1921c, 0xfe1deb1cb129a73e, 0xe88235f52ebb4484, 0xe99c7026b45f7e41,
    0x3991d639835339f4, 0x9c845f8bbdf9283b, 0x1ff897ffde05980f, 0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7,
    0x4f463f669e5fea2d, 0x7527bac7ebe5f17b, 0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab,
    0xf0cfbc209af4361d};
inline constexpr std::uint64_t kHalfPiBits = 0xc90fdaa22168c234;  // pi/2 times 2^63

// sin(x) = x + x z S(z), z = x^2, |x| <= pi/4.
inline constexpr double kSine[] = {-0x1.5555555555555p-3, 0x1.1111111110bb1p-7,   -0x1.a01a019e8357dp-13,
                                   0x1.71de37961e4c6p-19, -0x1.ae600a926c89ap-26, 0x1.5e0af186af739p-33};
// cos(x) = 1 - z/2 + z^2 C(z).
inline constexpr double kCosine[] = {0x1.5555555555555p-5,   -0x1.6c16c16c16966p-10, 0x1.a01a019f4e867p-16,
                                     -0x1.27e4fa17a41b4p-22, 0x1.1eeb68b109173p-29,  -0x1.907d7aebd5e3dp-37};

// atan(k/32).
inline constexpr Pair kArcTangents[] = {{0x0.0p+0, 0x0.0p+0},
                                        {0x1.ffd55bba97625p-6, -0x1.5ec431444912cp-60},
                                        {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
                                        {0x1.7ee182602f10fp-4, -0x1.cfb654c0c3d98p-58},
                                        {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                                        {0x1.3d6eee8c6626cp-3, 0x1.61a3b0ce9281bp-57},
                                        {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
                                        {0x1.b90d7529260a2p-3, 0x1.17b10d2e0e5abp-61},
                                        {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                        {0x1.18bf5a30bf178p-2, 0x1.30ca4748b1bf9p-57},
                                        {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
                                        {0x1.530ad9951cd4ap-2, -0x1.2566480884082p-57},
                                        {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                                        {0x1.8b24d394a1b25p-2, 0x1.b6d0ba3748fa8p-56},
                                        {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
                                        {0x1.c0db4c94ec9f0p-2, -0x1.cc1ce70934c34p-56},
                                        {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                        {0x1.f40dd0b541418p-2, -0x1.a3992dc382a23p-57},
                                        {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
                                        {0x1.1255d9bfbd2a9p-1, -0x1.2bdaee1c0ee35p-58},
                                        {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                                        {0x1.2958e59308e31p-1, -0x1.09e73b0c6c087p-56},
                                        {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
                                        {0x1.3f13fb89e96f4p-1, 0x1.ecf8b492644f0p-56},
                                        {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                        {0x1.538f57b89061fp-1, -0x1.1bb74abda520cp-55},
                                        {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
                                        {0x1.66d663923e087p-1, -0x1.6ea6febe8bbbap-56},
                                        {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                                        {0x1.78f6bbd5d315ep-1, 0x1.406a089803740p-55},
                                        {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
                                        {0x1.89ff5ff57f1f8p-1, -0x1.55b9a5e177a1bp-55},
                                        {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
inline constexpr int kArcTangentSteps = 32;

// 2^(k/32).
inline constexpr Pair kPowersOfTwo[] = {{0x1.0000000000000p+0, 0x0.0p+0},
                                        {0x1.059b0d3158574p+0, 0x1.d73e2a475b465p-55},
                                        {0x1.0b5586cf9890fp+0, 0x1.8a62e4adc610bp-54},
                                        {0x1.11301d0125b51p+0, -0x1.6c51039449b3ap-54},
                                        {0x1.172b83c7d517bp+0, -0x1.19041b9d78a76p-55},
                                        {0x1.1d4873168b9aap+0, 0x1.e016e00a2643cp-54},
                                        {0x1.2387a6e756238p+0, 0x1.9b07eb6c70573p-54},
                                        {0x1.29e9df51fdee1p+0, 0x1.612e8afad1255p-55},
                                        {0x1.306fe0a31b715p+0, 0x1.6f46ad23182e4p-55},
                                        {0x1.371a7373aa9cbp+0, -0x1.63aeabf42eae2p-54},
                                        {0x1.3dea64c123422p+0, 0x1.ada0911f09ebcp-55},
                                        {0x1.44e086061892dp+0, 0x1.89b7a04ef80d0p-59},
                                        {0x1.4bfdad5362a27p+0, 0x1.d4397afec42e2p-56},
                                        {0x1.5342b569d4f82p+0, -0x1.07abe1db13cadp-55},
                                        {0x1.5ab07dd485429p+0, 0x1.6324c054647adp-54},
                                        {0x1.6247eb03a5585p+0, -0x1.383c17e40b497p-54},
                                        {0x1.6a09e667f3bcdp+0, -0x1.bdd3413b26456p-54},
                                        {0x1.71f75e8ec5f74p+0, -0x1.16e4786887a99p-55},
                                        {0x1.7a11473eb0187p+0, -0x1.41577ee04992fp-55},
                                        {0x1.82589994cce13p+0, -0x1.d4c1dd41532d8p-54},
                                        {0x1.8ace5422aa0dbp+0, 0x1.6e9f156864b27p-54},
                                        {0x1.93737b0cdc5e5p+0, -0x1.75fc781b57ebcp-57},
                                        {0x1.9c49182a3f090p+0, 0x1.c7c46b071f2bep-56},
                                        {0x1.a5503b23e255dp+0, -0x1.d2f6edb8d41e1p-54},
                                        {0x1.ae89f995ad3adp+0, 0x1.7a1cd345dcc81p-54},
                                        {0x1.b7f76f2fb5e47p+0, -0x1.5584f7e54ac3bp-56},
                                        {0x1.c199bdd85529cp+0, 0x1.11065895048ddp-55},
                                        {0x1.cb720dcef9069p+0, 0x1.503cbd1e949dbp-56},
                                        {0x1.d5818dcfba487p+0, 0x1.2ed02d75b3707p-55},
                                        {0x1.dfc97337b9b5fp+0, -0x1.1a5cd4f184b5cp-54},
                                        {0x1.ea4afa2a490dap+0, -0x1.e9c23179c2893p-54},
                                        {0x1.f50765b6e4540p+0, 0x1.9d3e12dd8a18bp-54}};
inline constexpr int kPowerSteps = 32;
inline constexpr double kPerStep = 0x1.71547652b82fep+5;   // steps in 1
inline constexpr double kStepHigh = 0x1.62e42fefa0000p-6;  // ln(2)/32, 36 bits: products with 17 bits are exact
inline constexpr double kStepLow = 0x1.cf79abc9e3b3ap-45;  // the rest

inline constexpr double kLn2High = 0x1.62e42fefa3800p-1;  // ln(2), 42 bits: products with 11 bits are exact
inline constexpr double kLn2Low = 0x1.ef35793c76730p-45;  // the rest
// log((1+s)/(1-s)) = 2 s + s z R(z), z = s^2, from sqrt(1/2) to sqrt(2).
inline constexpr double kLogarithm[] = {0x1.5555555555558p-1, 0x1.99999999952e2p-2, 0x1.2492492df148dp-2,
                                        0x1.c71c62e5800a1p-3, 0x1.7462b4ab2ef6bp-3, 0x1.39fe606542ddep-3,
                                        0x1.2b584aae78a57p-3};

// cbrt(x), 1 <= x <= 2, to 2e-7: where it starts.
inline constexpr double kCubeRoot[] = {0x1.cb68f94b94beap-2, 0x1.e33114033c8b7p-1,  -0x1.4f65258278179p-1,
                                       0x1.8026ac948a766p-2, -0x1.1d2e558db1d25p-3, 0x1.e346250683378p-6,
                                       -0x1.6254d5208eb99p-9};
// cbrt(2^k).
inline constexpr double kCubeRoots[] = {0x1.0000000000000p+0, 0x1.428a2f98d728bp+0, 0x1.965fea53d6e3dp+0};

}  // namespace takt::maths
