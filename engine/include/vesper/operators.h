/** @file
 * The tone operators of Vesper: one line each, from which the enumeration, the command line and the shaders are made.
 * SPDX-License-Identifier: MIT
 */
#ifndef VESPER_OPERATORS_H
#define VESPER_OPERATORS_H

/** X(NAME, Name, name, value, summary) for every operator, by value. `name` is the word that users write, `value` stays
 * the same for ever. */
/* clang-format off */
#define VESPER_OPERATORS(X) \
    X(IRAWAN, Irawan, irawan, 0, \
      "Irawan, Ferwerda, Marschner 2005 (reconstructed): histogram adjustment for an eye " \
      "that adapts over time") \
    X(WARD, Ward, ward, 1, "Ward Larson, Rushmeier, Piatko 1997: histogram adjustment for an adapted eye") \
    X(REINHARD, Reinhard, reinhard, 2, "Reinhard, Stark, Shirley, Ferwerda 2002, global") \
    X(LINEAR, Linear, linear, 3, "linear between two luminances") \
    X(LDR, Ldr, ldr, 4, "no HDR: lamps of 1.0, sums clamped to 1") \
    X(PATTANAIK, Pattanaik, pattanaik, 5, \
      "Pattanaik, Tumblin, Yee, Greenberg 2000: responses of an eye that adapts over time") \
    X(FERWERDA, Ferwerda, ferwerda, 6, \
      "Ferwerda, Pattanaik, Shirley, Greenberg 1996: linear gains of cones and rods") \
    X(DURAND, Durand, durand, 7, \
      "Durand, Dorsey 2000 (reconstructed): gains of cones and rods of an eye that adapts " \
      "over time, also to colour") \
    X(GRAVE, Grave, grave, 8, \
      "Grave, Bremond 2008 (reconstructed): bands of contrast, each with the visibility level " \
      "it has in the scene") \
    X(DRAGO, Drago, drago, 9, "Drago, Myszkowski, Annen, Chiba 2003: logarithms of a base that goes with luminance") \
    X(DEVLIN, Devlin, devlin, 10, "Reinhard, Devlin 2005: each channel is the response of a photoreceptor") \
    X(NEUTRAL, Neutral, neutral, 11, "Khronos PBR Neutral 2024, a baseline for comparison, not psychophysical")
/* clang-format on */

#endif
