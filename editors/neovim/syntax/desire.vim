" made by python -m docs.generate from the tables of words; edit docs/editor_grammars.py
if exists("b:current_syntax") | finish | endif
syntax case match
syntax iskeyword @,48-57,_,$
syntax match desireOperator '[-+*/^=<>&%#|]'
syntax match desireNumber '\<&&\?\x\+\>'
syntax match desireNumber '\<\d\+\.\?\d*\%([eE][+-]\?\d\+\)\?\>'
syntax match desireNumber '\.\d\+\%([eE][+-]\?\d\+\)\?\>'
syntax keyword desireSystem t TMAX DT NN scale DTMAX DTMIN ERMAX ERMIN ERRMAX CHECKN MM iRow PI
syntax keyword desireWord then to step and or not as
syntax match desireFunction '\<\%(Arg\|Cabs\|Conjug\|Im\|Re\|SAT\|SIGMOID\|abs\|acos\|asin\|atan\|atan2\|ceil\|comp\|cos\|cosh\|deadc\|deadz\|delay\|exp\|expj\|floor\|func1\|func2\|gauss\|heav\|lim\|ln\|log\|max\|min\|mod\|ran\|recip\|rect\|round\|sat\|sgn\|sigmoid\|sin\|sinc\|sinh\|sqrt\|swtch\|tan\|tanh\|tim\|tri\|trnc\|white\)\ze\s*('
syntax match desireKeyword '\%(^\s*\%(\d\+\s\)\?\s*\||\s*\|\<then\s\+\|\<else\s\+\)\@<=\%(go\s\+to\|end\s\+\%(if\|while\|event\)\|d/dt\|disconnect\|PROCEDURE\|dimension\|FUNCTION\|JACOBIAN\|SUBMODEL\|notebook\|snapshot\|COMPLEX\|DYNAMIC\|INTEGER\|compare\|connect\|display\|proceed\|recover\|restore\|CLEARN\|DISPXY\|MATRIX\|Matrix\|PLEARN\|SAMPLE\|UPDATE\|VECTOR\|Vector\|dispxy\|invoke\|reload\|repeat\|tdelay\|trkhld\|xlabel\|ylabel\|ARRAY\|DELTA\|Delta\|LEARN\|MACRO\|STATE\|VECTR\|Vectr\|clear\|delay\|delta\|dispt\|drunr\|event\|every\|func2\|input\|irule\|label\|reset\|stash\|store\|title\|trace\|units\|until\|while\|write\|INTP\|SEED\|SHOW\|STOP\|auto\|call\|data\|drun\|dump\|edit\|else\|erun\|exit\|fast\|func\|help\|keep\|list\|load\|next\|note\|plot\|quit\|read\|step\|term\|time\|type\|AVG\|DOT\|FFT\|MAT\|Mat\|NEW\|OUT\|bye\|end\|for\|get\|new\|old\|rld\|run\|ed\|go\|if\|sh\|zz\)\>\%(\s*=\)\@!'
syntax region desireString start=+'+ end=+'+ oneline
syntax region desireString start=+"+ end=+"+ oneline
syntax match desireComment '\%(--\|—\).*$'
highlight default link desireOperator Operator
highlight default link desireNumber Number
highlight default link desireSystem Identifier
highlight default link desireWord Keyword
highlight default link desireFunction Function
highlight default link desireKeyword Statement
highlight default link desireString String
highlight default link desireComment Comment
let b:current_syntax = 'desire'
