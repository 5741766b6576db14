#pragma once

/// Copies a file into the program, between symbol_begin and symbol_end. The build gives the path; the
/// assembler copies the file in.
#define SWEEPSCOPE_EMBED(symbol, path)                                                     \
  __asm__(".section .rodata\n.balign 16\n" symbol "_begin:\n.incbin \"" path "\"\n" symbol \
          "_end:\n.byte 0\n.previous\n")
