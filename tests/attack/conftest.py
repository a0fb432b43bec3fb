"""Attacks import each other as their program does; what pytest collects are their tests."""

collect_ignore_glob = ["[!t]*.py"]
