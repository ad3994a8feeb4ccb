"""Utilities/check_advice.py sees advice, and which of it tests follow."""
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "Utilities"))
sys.dont_write_bytecode = True
import check_advice


class Advice(unittest.TestCase):
    def test_texts_are_joined_and_comments_are_none(self):
        source = '// "not a text of this"\n#include "one two three"\nf("Give it " + name,\n' \
                 '  "a name, "\n  "or \\"none\\" of it");\n'
        self.assertEqual(check_advice.texts(source), ['a name, or \\"none\\" of it'])

    def test_advice_begins_a_clause(self):
        for text in ("It is open: close it.", "Raise the weights.", "split it, or decimate it",
                     "For reliable values use three rows."):
            self.assertTrue(check_advice.VERBS.search(text), text)
        for text in ("a point that is used twice", "it could not be set", "the rows to remove"):
            self.assertFalse(check_advice.VERBS.search(text), text)

    def test_a_phrase_in_the_text_follows_it(self):
        self.assertTrue(check_advice.is_followed("It is open: close it.", {"close it."}))
        self.assertFalse(check_advice.is_followed("It is open: close it.", {"open it"}))

    def test_exemptions_are_in_the_sources(self):
        all_texts = [text for path in check_advice.sources()
                     for text in check_advice.texts(path.read_text(encoding="utf-8"))]
        for phrase in check_advice.EXEMPT:
            self.assertTrue(any(phrase in text for text in all_texts), phrase)


unittest.main()
