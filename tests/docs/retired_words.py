# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
"""Words that the house style retires, each with what to write instead."""
import re

RETIRED = [
    (re.compile(pattern, re.IGNORECASE), instead)
    for pattern, instead in [
        (r"\bforet(?:ell|ells|old|elling)\b", "predict"),
        (r"\banew\b", "again"),
        (r"\bbehind (?:it|them|that|each|step|its step|(?:a|the|each|one) (?:step|stage|run|fault|end|"
         r"frame|call|others?))\b", "after"),
        (r"\bof late\b", "recently"),
        (r"\bas ever\b", "as always"),
        (r"\bamiss\b", "wrong"),
        (r"\bdear(?:er|est)\b", "more expensive"),
        (r"\b(?:where )?(?:the )?numbers end\b", "at extreme inputs"),
        (r"\bwhere it ends\b", "at the end"),
        (r"\bthe other precision\b", "single or double precision"),
        (r"\bbe had\b", "be obtained"),
        (r"\bowed to\b", "comes from"),
        (r"\bwarned of\b", "the program warns"),
        (r"\bfares?\b", "behaves"),
        (r"\bbut with an?\b", "unless"),
        (r"\b(?:whence|hitherto|thereof|wherein|whither|albeit|whosoever|whoever)\b",
         "an everyday word"),
    ]
]


def retired_words(text):
    """The retired words in a text, as (word, what to write instead)."""
    return [(match.group(0), instead) for pattern, instead in RETIRED
            for match in pattern.finditer(text)]
