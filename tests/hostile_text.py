"""Names that try to be markup, code or a path in some format."""

HOSTILE = {
    "script": "<script>alert(1)</script>",
    "image": '"><img src=x onerror=alert(1)>',
    "entities": "A & B < C > D &lt; &amp;",
    "percent": "100 % of $x_i$ \\% {curly} #1 ~^",
    "input": "\\input{/etc/passwd} \\write18{id} \\end{document}",
    "typst": '#eval("1") #image("/etc/passwd") *bold* _it_ `raw` $ x $ @ref <label> // c /* d */',
    "quotes": 'it\'s "quoted" `back` “curly”',
    "lines": "one\ntwo\r\nthree\ttab",
    "controls": "nul\x00bell\x07esc\x1bdel\x7f",
    "right to left": "abc \u202eevil\u202c \u0634\u0645\u0633 \u05e9\u05de\u05e9",
    "template": "{{ 7*7 }} {% raw %} \\VAR{x} \\BLOCK{y}",
    "closing": "</script><!-- --> ]]> </style> </title>",
    "plotly": "%{y} <b>bold</b><br><a href='javascript:alert(1)'>link</a>",
    "path": "../../etc/passwd; rm -rf / | cat > x",
    "long": "x" * 10_000,
    "words": "long words " * 900,
    "unicode": "β₀ Ω ≥ 10⁻³ − … 漢字 🛰️ é",
    "surrogate": "bad \udcff name",
    "csv": '=1+1,"a",@SUM(A1)',
}
