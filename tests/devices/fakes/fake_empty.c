/* SPDX-License-Identifier: Apache-2.0 */
/* A library that has none of a vendor's functions but the first. */
int dhdOpenID(char id) { return id; }
unsigned hdInitDevice(const char* name) { return name ? 0u : 1u; }
